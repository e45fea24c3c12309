//! `sprag schema`: the keys of scenes and studies for editors and other programs.

use clap::{Args, ValueEnum};
use serde_json::Value;
use sprag_sim::keys::Described;
use sprag_sim::scene::schema::SceneFile;
use sprag_studies::cloud::study_file::StudyFile;

use super::context::{Completion, Context, Run};

/// Print the JSON schema of scenes or studies, for editors.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag schema scene > scene.schema.json\n\n\
    An editor that reads TOML schemas completes and checks the keys of a file whose first line is\n  #:schema scene.schema.json\n\
    `sprag new` and `sprag example` write that line, and the schema beside the file.")]
pub struct SchemaArguments {
    /// What the schema is of.
    #[arg(value_name = "KIND")]
    pub kind: Kind,
}

/// Kinds of TOML files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Kind {
    /// Block, devices and ground motion.
    Scene,
    /// Many records, for `cloud` and `optimise`.
    Study,
}

impl Kind {
    /// The name of the file with its schema.
    pub fn schema_file(self) -> &'static str {
        match self {
            Kind::Scene => "scene.schema.json",
            Kind::Study => "study.schema.json",
        }
    }

    fn schema(self) -> &'static Value {
        match self {
            Kind::Scene => SceneFile::schema(),
            Kind::Study => StudyFile::schema(),
        }
    }

    /// Schema of the file as text.
    pub fn schema_text(self) -> String {
        format!("{:#}\n", self.schema())
    }
}

impl Run for SchemaArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        // What cannot be written is reported where standard output ends.
        let _ = context.out.write_all(self.kind.schema_text().as_bytes());
        Ok(Completion::Complete)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn the_schemas_of_the_repository_are_those_of_the_program() {
        let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes"));
        for kind in [Kind::Scene, Kind::Study] {
            let file = folder.join(kind.schema_file());
            let there = std::fs::read_to_string(&file).unwrap_or_default();
            assert!(there == kind.schema_text(), "{} is not what `sprag schema` prints", file.display());
        }
    }
}
