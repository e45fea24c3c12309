//! `sprag new`: a scene or study to start from.

use std::io::{BufReader, Read, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use sprag_report::output::{OutputError, Results, claim_file};
use sprag_sim::keys::template::template;
use sprag_sim::scene::schema::SceneFile;
use sprag_studies::cloud::study_file::StudyFile;

use super::context::{Completion, Context, Run};
use super::out_arguments::OverwriteArguments;
use super::schema::Kind;

/// Write a scene or study to start from, with all keys explained.
#[derive(Args, Clone, Debug)]
#[command(
    after_help = "Examples:\n  sprag new scene\n  sprag new scene pier.toml && sprag simulate pier.toml\n  sprag new study\n\n\
    Writes the file, and beside it the schema by which editors complete and check its keys."
)]
pub struct NewArguments {
    /// What to write.
    #[arg(value_name = "KIND")]
    pub kind: Kind,
    /// The file; scene.toml or study.toml without it.
    #[arg(value_name = "FILE", value_hint = clap::ValueHint::FilePath)]
    pub file: Option<PathBuf>,
    #[command(flatten)]
    pub replace: OverwriteArguments,
}

/// A scene that runs.
const SCENE: &[(&str, &str)] = &[
    ("title", "\"A block with a pair of clutched inerters\""),
    ("block.size_m", "2.0"),
    ("block.slenderness_deg", "10.0"),
    ("device.N.kind", "\"clutched-pair\""),
    ("device.N.mass_ratio", "0.5"),
    ("ground.N.motion", "\"sine\""),
    ("ground.N.amplitude_ratio", "1.5"),
    ("ground.N.frequency_ratio", "3.0"),
];

/// A study that runs where there are records.
const STUDY: &[(&str, &str)] = &[("title", "\"A pier under records\""), ("records", "[\"records\"]")];

/// The file of this `kind` to start from.
fn text(kind: Kind) -> String {
    const SHOWN: &str = "A key that is commented out is shown with its default, or with an example where it has none.";
    let body = match kind {
        Kind::Scene => template::<SceneFile>(&format!("A scene for `sprag simulate FILE`.\n{SHOWN}"), SCENE),
        Kind::Study => {
            template::<StudyFile>(&format!("A study for `sprag cloud FILE` and `sprag optimise FILE`.\n{SHOWN}"), STUDY)
        }
    };
    format!("#:schema {}\n{body}", kind.schema_file())
}

impl Run for NewArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        if self.file.as_deref() == Some(Path::new("-")) {
            context.print(text(self.kind));
        } else {
            write(self)?.iter().for_each(|path| context.print(format_args!("{}\n", path.display())));
        }
        Ok(Completion::Complete)
    }
}

fn write(arguments: &NewArguments) -> Result<[PathBuf; 2], OutputError> {
    let kind = arguments.kind;
    let file = arguments.file.clone().unwrap_or_else(|| match kind {
        Kind::Scene => "scene.toml".into(),
        Kind::Study => "study.toml".into(),
    });
    let text = text(kind);
    let same = |mut there: BufReader<_>| {
        let mut present = String::new();
        there.read_to_string(&mut present).is_ok_and(|_| present == text)
    };
    claim_file(&file, &[], arguments.replace.overwrite, same)?;
    let schema = file.parent().unwrap_or(Path::new("")).join(kind.schema_file());
    let mut results = Results::default();
    results.add(&file, |to| to.write_all(text.as_bytes()))?;
    results.add(&schema, |to| to.write_all(kind.schema_text().as_bytes()))?;
    results.commit()?;
    Ok([file, schema])
}

#[cfg(test)]
mod tests {
    use sprag_sim::keys::Described;
    use sprag_sim::keys::list::keys;
    use sprag_sim::scene::{Scene, SceneError, document};

    use super::*;

    /// `text` with line `index`, and the header of its table, no longer commented out.
    fn with_line(text: &str, index: usize) -> String {
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        let header = (0..=index).rev().find(|line| lines[*line].starts_with("#[") || lines[*line].starts_with('['));
        for line in header.into_iter().chain([index]) {
            lines[line] = lines[line].trim_start_matches('#').to_owned();
        }
        lines.join("\n")
    }

    #[test]
    fn a_new_file_is_read_and_has_every_key() {
        Scene::parse(&text(Kind::Scene), "scene").unwrap();
        document::from_text::<StudyFile>(&text(Kind::Study), "study").unwrap();
        for (kind, schema) in [(Kind::Scene, SceneFile::schema()), (Kind::Study, StudyFile::schema())] {
            let text = text(kind);
            let shown = |name: &str| {
                text.lines().any(|line| {
                    let line = line.trim_start_matches(['#', ' ', '[']);
                    line.strip_prefix(name).is_some_and(|rest| rest.starts_with([' ', ':', ']']))
                })
            };
            for key in keys(schema) {
                // Within its table, or within the list that it belongs to.
                let mut names = key.path.match_indices('.').map(|(dot, _)| &key.path[dot + 1..]);
                assert!(shown(&key.path) || names.any(shown), "{}", key.path);
            }
        }
    }

    #[test]
    fn every_key_of_a_new_file_may_be_commented_in() {
        for kind in [Kind::Scene, Kind::Study] {
            let text = text(kind);
            let is_key = |line: &str| {
                line.strip_prefix('#').is_some_and(|line| line.starts_with(|first: char| first.is_ascii_lowercase()))
            };
            let mut count = 0;
            for index in text.lines().enumerate().filter(|(_, line)| is_key(line)).map(|(index, _)| index) {
                let changed = with_line(&text, index);
                let refused = match kind {
                    Kind::Scene => Scene::parse(&changed, "scene").err(),
                    Kind::Study => document::from_text::<StudyFile>(&changed, "study").err(),
                };
                // A key may need others, or leave no room for them.
                let reads = match &refused {
                    None | Some(SceneError::Conflict { .. } | SceneError::Missing { .. }) => true,
                    Some(SceneError::Syntax { message, .. }) => message.contains("missing field"),
                    Some(_) => false,
                };
                assert!(reads, "{}: {}", text.lines().nth(index).unwrap(), refused.unwrap());
                count += 1;
            }
            assert!(count > 15, "{count} keys of a {kind:?}");
        }
    }

    #[test]
    fn a_file_that_is_there_is_kept() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("pier.toml");
        let arguments =
            |overwrite| NewArguments { kind: Kind::Scene, file: Some(file.clone()), replace: OverwriteArguments { overwrite } };
        std::fs::write(&file, "mine").unwrap();
        assert!(write(&arguments(false)).unwrap_err().to_string().contains("--overwrite"));
        assert_eq!(std::fs::read_to_string(&file).unwrap(), "mine");
        write(&arguments(true)).unwrap();
        assert_eq!(std::fs::read_to_string(&file).unwrap(), text(Kind::Scene));
        assert!(folder.path().join("scene.schema.json").exists());
    }
}
