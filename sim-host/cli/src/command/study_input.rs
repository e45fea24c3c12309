//! What commands that run a study over records have in common: the study, its records, and what is said of them on the command line.

use std::path::{Path, PathBuf};

use clap::Args;
use rayon::ThreadPool;
use sprag_report::output::{Digest, Subject};
use sprag_report::progress::Progress;
use sprag_sim::record::Record;
use sprag_studies::cloud::records::{StudyRecord, StudyRecords};
use sprag_studies::cloud::study::{Study, StudyError};

use super::context::Context;
use super::out_arguments::file_of;
use super::record_arguments::ReadArguments;

/// A study and its records.
#[derive(Args, Clone, Debug)]
pub struct StudyArguments {
    /// Study file: records, structures, devices, and what is asked of them.
    #[arg(value_name = "STUDY.toml")]
    pub study: PathBuf,
    /// Records and folders of them, in the place of the study's.
    #[arg(long, value_name = "PATH", num_args = 1..)]
    pub records: Vec<PathBuf>,
    #[command(flatten)]
    pub reading: ReadArguments,
    /// Change one value in every structure of the study, such as block.size_m=2 or device.1.mass_ratio=0.5; may be given more than once.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

impl StudyArguments {
    /// The study, with one more `change` of its structures.
    pub fn load(&self, change: Option<String>) -> Result<Study, StudyError> {
        let mut changes = self.set.clone();
        changes.extend(change);
        let mut study = Study::load(&self.study, &changes, &self.records)?;
        study.apply_record_options(&self.reading.table());
        Ok(study)
    }

    /// The records of `study`, one at least unless it needs `none`, and the warnings of both, which are reported with what cannot be read.
    ///
    /// # Errors
    /// What the study says of its records and cannot be, and where none can be read.
    pub(super) fn read(
        &self,
        study: &Study,
        none: bool,
        pool: &ThreadPool,
        context: &mut Context<'_>,
    ) -> anyhow::Result<(StudyRecords, Vec<String>)> {
        let reading = Progress::uncounted("reading records");
        let records = pool.install(|| StudyRecords::read(study))?;
        reading.finish();
        if records.records.is_empty() && !none {
            let first = records.unreadable.first().map_or_else(String::new, |line| format!("; {line}"));
            anyhow::bail!("{}: no record could be read{first}", self.study.display());
        }
        for line in &records.unreadable {
            context.note(line);
        }
        let warnings = context.warned(study.warnings().into_iter().chain(records.warnings()));
        Ok((records, warnings))
    }

    /// The files that were read: the study, its scene and its records.
    pub(super) fn files(&self, study: &Study, records: &StudyRecords) -> Vec<PathBuf> {
        let folder = self.study.parent().unwrap_or(Path::new(""));
        let scene = study.file.scene.iter().map(|scene| folder.join(scene));
        let records = records.records.iter().map(|record| file_of(Path::new(&record.motion.record.name)));
        std::iter::once(self.study.clone()).chain(scene).chain(records).collect()
    }
}

/// What results of `command` are of, as far as it is the samples of every record.
pub fn study_subject(command: &str, records: &[StudyRecord]) -> Subject {
    let digest = |record: &StudyRecord| {
        let Record { time_step_s, acceleration_m_s2, .. } = &record.motion.record;
        let bytes: Vec<u8> =
            std::iter::once(time_step_s).chain(acceleration_m_s2).flat_map(|value| value.to_le_bytes()).collect();
        (record.name.clone(), Digest::of_bytes(&bytes))
    };
    Subject::new(command, records.iter().map(digest).collect())
}
