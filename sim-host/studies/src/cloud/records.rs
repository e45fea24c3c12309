//! The records of a study: files named one by one, and those of folders.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use rayon::prelude::*;
use sprag_sim::ground_motion::{self, GroundMotion};
use sprag_sim::record::{
    Component, ReadOptions, Record, RecordError, RecordSummary, STANDARD_GRAVITY_M_S2, Warning, every_warning, warning_lines,
};
use sprag_sim::scene::SceneError;
use sprag_sim::scene::error::KeyPath;
use sprag_sim::scene::motions::GroundMotions;

use super::folder::{self, Named};
use super::measure::MeasuredRecord;
use super::record_name::{self, Unnamed, same_file};
use super::study::{Study, check_units};
use super::study_file::{DescribedRecord, RecordEntry};

/// A record of a study.
#[derive(Clone, Debug)]
pub struct StudyRecord {
    /// As tables print it: its path below the folder that was named, or the name of the file; its whole path where others are
    /// called so too.
    pub name: String,
    /// The record and its measures.
    pub motion: MeasuredRecord,
    /// Its earthquake: by the name that the study gives, else by the day in its title; none where both are silent.
    pub event: Option<String>,
}

impl StudyRecord {
    /// The motion of `record`, which tables print as `name`, of the earthquake `event`, or of the one that its title names.
    pub fn of(name: String, record: Record, event: Option<String>) -> StudyRecord {
        let event = event.or_else(|| record.event_date().map(|date| date.to_string()));
        StudyRecord { name, motion: record.into(), event }
    }

    /// The record times `factor` as a ground motion that starts at `start_s`.
    pub fn ground(&self, factor: f64, start_s: f64) -> GroundMotions {
        let Record { acceleration_m_s2, time_step_s, .. } = &self.motion.record;
        let samples = acceleration_m_s2.iter().map(|a| factor * a / STANDARD_GRAVITY_M_S2);
        let component = ground_motion::Component::record(start_s, *time_step_s, samples);
        GroundMotions::of(GroundMotion::sum(&[component]), None)
    }
}

/// The records of a study, and what could not be read.
#[derive(Clone, Debug, Default)]
pub struct StudyRecords {
    /// By the order in the study, within a folder by path.
    pub records: Vec<StudyRecord>,
    /// One line for each file or folder without a record; names the file.
    pub unreadable: Vec<String>,
    /// One line for each folder in which something was passed over.
    pub passed_over: Vec<String>,
}

/// How much a study says of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Described {
    /// Nothing.
    Bare,
    /// What its folder's entry says.
    OfFolder,
    /// Which component of it is meant, behind its `#`.
    Component,
    /// What its own entry says.
    Alone,
}

/// A file to be read.
struct Source {
    name: String,
    path: PathBuf,
    /// Its file, however it is named.
    file: PathBuf,
    options: ReadOptions,
    event: Option<String>,
    described: Described,
}

impl Source {
    /// The file, and the component that is asked of it.
    fn asked(&self) -> (PathBuf, Option<String>) {
        let component = self.options.component.as_ref().map(|component| component.to_string().to_lowercase());
        (self.file.clone(), component)
    }

    fn unnamed(&self) -> Unnamed {
        // `FILE#NAME` says it already.
        let part = self.options.component.as_ref().filter(|_| Component::of_path(&self.path).is_none());
        let part = part.map(ToString::to_string);
        Unnamed { short: self.name.clone(), path: self.path.clone(), file: self.file.clone(), part }
    }
}

impl StudyRecords {
    /// Reads the records of `study`, on rayon's threads. A file, or a component of it, that is named twice counts once, as the entry says
    /// that describes it.
    ///
    /// # Errors
    /// [`SceneError`] for units or a time step of an entry outside their range; a file that cannot be read is among
    /// [`StudyRecords::unreadable`].
    pub fn read(study: &Study) -> Result<StudyRecords, SceneError> {
        let mut found = StudyRecords::default();
        let mut sources = sources(study, &mut found)?;
        let mut described: BTreeMap<PathBuf, Described> = BTreeMap::new();
        let mut alone = BTreeSet::new();
        for source in &sources {
            let most = described.entry(source.file.clone()).or_insert(source.described);
            *most = source.described.max(*most);
            alone.extend((source.described == Described::Alone).then(|| source.asked()));
        }
        let mut seen = BTreeSet::new();
        sources.retain(|source| {
            let of_component = source.described == Described::Component && !alone.contains(&source.asked());
            (described.get(&source.file) == Some(&source.described) || of_component) && seen.insert(source.asked())
        });
        let read: Vec<_> = sources.par_iter().map(|source| Record::read(&source.path, &source.options)).collect();
        let mut read: Vec<_> = sources.into_iter().zip(read).collect();
        drop_repeated(&mut read);
        let names = record_name::names(&read.iter().map(|(source, _)| source.unnamed()).collect::<Vec<_>>());
        for (name, (source, record)) in names.into_iter().zip(read) {
            match record {
                Ok(record) => found.records.push(StudyRecord::of(name, record.as_horizontal(), source.event)),
                Err(error) => found.unreadable.push(match error.key() {
                    Some(key) => format!("{error}, or record.{key} in {}", study.origin),
                    None => error.to_string(),
                }),
            }
        }
        Ok(found)
    }

    /// The records as summaries have them.
    pub fn summaries(&self) -> Vec<RecordSummary> {
        self.records.iter().map(|record| RecordSummary::of(&record.motion.record, &record.name)).collect()
    }

    /// What a person should look at, all of it.
    pub fn every_warning(&self) -> Vec<String> {
        [self.passed_over.clone(), every_warning(&self.summaries())].concat()
    }

    /// What a person should look at, in a few lines.
    pub fn warnings(&self) -> Vec<String> {
        let is_vertical = |warning: &Warning| matches!(warning, Warning::VerticalComponent { .. });
        let mut lines = self.passed_over.clone();
        let vertical = self.records.iter().filter(|record| record.motion.record.warnings.iter().any(is_vertical));
        let vertical: Vec<&str> = vertical.map(|record| record.name.as_str()).collect();
        if !vertical.is_empty() {
            lines.push(format!(
                "vertical components by their names or headers, taken as horizontal motions: {} of {} records: {}",
                vertical.len(),
                self.records.len(),
                folder::first_of(&vertical)
            ));
        }
        let mut others = self.summaries();
        for (summary, record) in others.iter_mut().zip(&self.records) {
            // Said above, and the last of a record's warnings.
            let kept = record.motion.record.warnings.iter().filter(|warning| !is_vertical(warning));
            summary.warnings = kept.map(ToString::to_string).collect();
        }
        lines.extend(warning_lines(&others));
        lines
    }
}

/// Leaves one of the records that turn out to be of the same component of the same file, whatever they were asked for by: that of
/// which the study says most, of these the first.
fn drop_repeated(read: &mut Vec<(Source, Result<Record, RecordError>)>) {
    let of = |source: &Source, record: &Record| (source.file.clone(), record.component.clone());
    let mut counted: BTreeMap<_, (Described, usize)> = BTreeMap::new();
    for (index, (source, record)) in read.iter().enumerate() {
        if let Ok(record) = record {
            let first = counted.entry(of(source, record)).or_insert((source.described, index));
            if source.described > first.0 {
                *first = (source.described, index);
            }
        }
    }
    let mut index = 0..;
    read.retain(|(source, record)| {
        let at = index.next();
        record.as_ref().map_or(true, |record| counted.get(&of(source, record)).map(|counted| counted.1) == at)
    });
}

/// The files of `study`; what is no file, and folders without any, are noted in `found`.
fn sources(study: &Study, found: &mut StudyRecords) -> Result<Vec<Source>, SceneError> {
    let mut sources = Vec::new();
    for (index, entry) in study.file.records.iter().enumerate() {
        let mut options = study.reading.clone();
        let mut event = None;
        let path = match entry {
            RecordEntry::Path(path) => path,
            RecordEntry::Described(DescribedRecord { file, units, time_step_s, component, event: named }) => {
                event.clone_from(named);
                let key = |key: &str| KeyPath { origin: study.origin.clone(), key: key.to_owned() };
                check_units(units.as_deref(), &format!("records.{index}"), &key)?;
                options.units = units.as_ref().and_then(|units| units.parse().ok()).or(options.units);
                options.time_step_s = time_step_s.or(options.time_step_s);
                options.component = component.as_deref().map(Component::from).or(options.component);
                file
            }
        };
        let path = study.folder.join(path);
        let named = Named::of(std::slice::from_ref(&path));
        found.passed_over.extend(named.passed_over);
        found.unreadable.extend(named.unreadable);
        for file in named.files {
            let name = match file.strip_prefix(&path) {
                Ok(inside) if !inside.as_os_str().is_empty() => folder::shown(inside),
                _ => file.file_name().map_or_else(|| folder::shown(&file), |name| name.to_string_lossy().into_owned()),
            };
            let described = match entry {
                RecordEntry::Path(_) => Described::Bare,
                RecordEntry::Described(_) if file == path => Described::Alone,
                RecordEntry::Described(_) => Described::OfFolder,
            };
            let (mut options, event) = (options.clone(), event.clone());
            let (known, described) = match Component::of_path(&file) {
                Some((of, component)) => {
                    options.component = Some(component);
                    (same_file(&of), described.max(Described::Component))
                }
                None => (same_file(&file), described),
            };
            sources.push(Source { name, path: file, file: known, options, event, described });
        }
    }
    Ok(sources)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::cloud::study_file::RecordTable;

    fn study(folder: &Path, records: &str) -> Study {
        Study::parse(&format!("records = {records}"), "study.toml", folder, &[], &[]).unwrap()
    }

    fn names(found: &StudyRecords) -> Vec<&str> {
        found.records.iter().map(|record| record.name.as_str()).collect()
    }

    #[test]
    fn folders_are_searched_and_files_are_read_once() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::create_dir_all(at("a/deeper")).unwrap();
        std::fs::create_dir_all(at("empty")).unwrap();
        for name in ["a/2.csv", "a/1.csv", "a/deeper/1.csv", "b.csv", "a/.hidden.csv"] {
            std::fs::write(at(name), "time_s,acc_g\n0,0\n0.01,0.1\n0.02,0.2\n").unwrap();
        }
        std::fs::write(at("a/README.md"), "not a record").unwrap();
        std::fs::write(at("a/broken.csv"), "no numbers").unwrap();
        let found = StudyRecords::read(&study(folder.path(), "['a', 'b.csv', 'a/1.csv', 'empty', 'gone.csv']")).unwrap();
        assert_eq!(names(&found), ["1.csv", "2.csv", "deeper/1.csv", "b.csv"]);
        assert_eq!(found.unreadable.len(), 3, "{:?}", found.unreadable);
        for part in ["empty: no file in it", "broken.csv", "gone.csv"] {
            assert!(found.unreadable.iter().any(|line| line.contains(part) && !line.contains('\n')), "{part}");
        }
        // Two of one name are distinguished.
        let found = StudyRecords::read(&study(folder.path(), "['a/1.csv', 'a/deeper/1.csv']")).unwrap();
        assert!(names(&found)[0].ends_with("/a/1.csv") && names(&found)[1].ends_with("/a/deeper/1.csv"));
    }

    const TWO_COMPONENTS: &str = r#"{ "dT": 0.01, "data_x": [0.0, 1.0, 0.0], "data_y": [0.0, 3.0, 0.0] }"#;

    #[test]
    fn components_of_a_file_are_records_of_their_own() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("both.json"), TWO_COMPONENTS).unwrap();
        let entry = |component: &str| format!("{{ file = 'both.json', component = '{component}' }}");
        let [x, y] = ["x", "y"].map(entry);
        let found = StudyRecords::read(&study(folder.path(), &format!("[{x}, {y}, {x}]"))).unwrap();
        assert_eq!(names(&found), ["both.json, x", "both.json, y"], "{:?}", found.unreadable);
        let peaks: Vec<f64> = found.records.iter().map(|record| record.motion.intensity.pga_m_s2).collect();
        assert_eq!(peaks[1], 3.0 * peaks[0]);
    }

    #[test]
    fn a_component_counts_once_however_it_is_named() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("a")).unwrap();
        for file in ["both.json", "a/both.json"] {
            std::fs::write(folder.path().join(file), TWO_COMPONENTS).unwrap();
        }
        let of = |records: &str| StudyRecords::read(&study(folder.path(), records)).unwrap();
        let x = "{ file = 'both.json', component = '1', event = 'A' }";
        for (records, expected) in [
            ("['both.json#x', 'both.json#X', 'both.json#1', 'a/../both.json#x']".to_owned(), "both.json#x"),
            (format!("['both.json#x', {x}]"), "both.json"),
            (format!("[{x}, 'both.json#X']"), "both.json"),
            // The larger peak is that of y.
            ("['both.json', { file = 'both.json', component = 'y' }]".to_owned(), "both.json"),
            ("['both.json', 'both.json#y']".to_owned(), "both.json#y"),
        ] {
            let found = of(&records);
            assert_eq!((names(&found), &found.unreadable[..]), (vec![expected], &[][..]), "{records}");
            assert_eq!(found.records[0].event.as_deref(), records.contains("event").then_some("A"), "{records}");
        }
        for records in
            ["['both.json#x', 'both.json#y']".to_owned(), format!("['both.json#y', {x}]"), format!("[{x}, 'both.json#2']")]
        {
            assert_eq!(of(&records).records.len(), 2, "{records}");
        }
        // One of a folder is replaced by those that are named.
        assert_eq!(names(&of("['a', 'a/both.json#x', 'a/both.json#y']")), ["both.json#x", "both.json#y"]);
    }

    #[test]
    fn the_entry_that_describes_a_file_counts() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("a")).unwrap();
        std::fs::write(folder.path().join("a/plain.g3"), "0 1 2 1 0").unwrap();
        std::fs::write(folder.path().join("a/1.csv"), "time_s,acc_g\n0,0\n0.01,0.1\n0.02,0.2\n").unwrap();
        let own = "{ file = 'a/plain.g3', units = 'm/s2', time_step_s = 0.02 }";
        let of_folder = "{ file = 'a', event = 'all' }";
        for entries in [format!("['a', {own}]"), format!("[{own}, 'a']"), format!("[{of_folder}, {own}, 'a/1.csv']")] {
            let found = StudyRecords::read(&study(folder.path(), &entries)).unwrap();
            assert_eq!((found.records.len(), &found.unreadable[..]), (2, &[][..]), "{entries}");
            for record in &found.records {
                let all = entries.contains("all") && record.name == "1.csv";
                assert_eq!(record.event.as_deref(), all.then_some("all"), "{entries}: {}", record.name);
            }
        }
        let events = "['a/1.csv', { file = 'a/1.csv', event = 'A' }, { file = 'a/1.csv', event = 'B' }]";
        let found = StudyRecords::read(&study(folder.path(), events)).unwrap();
        let of: Vec<Option<&str>> = found.records.iter().map(|record| record.event.as_deref()).collect();
        assert_eq!(of, [Some("A")]);
    }

    #[test]
    fn what_a_file_does_not_say_comes_from_its_entry_or_the_study() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("plain.g3"), "0 1 2 1 0").unwrap();
        let of = |records: &str| StudyRecords::read(&study(folder.path(), records)).unwrap();
        assert_eq!(of("['plain.g3']").records.len(), 0);
        let described = of("[{ file = 'plain.g3', units = 'm/s2', time_step_s = 0.02 }]");
        assert_eq!(described.records[0].motion.record.time_step_s, 0.02);
        let mut given = study(folder.path(), "['plain.g3']");
        let units = Some("m/s2".to_owned());
        given.apply_record_options(&RecordTable { units, time_step_s: Some(0.02), ..RecordTable::default() });
        assert_eq!(StudyRecords::read(&given).unwrap().records[0].motion.record, described.records[0].motion.record);
        let of_all = of("['plain.g3']\n[record]\nunits = 'm/s2'\ntime_step_s = 0.02");
        assert_eq!(of_all.records[0].motion.record, described.records[0].motion.record);
        let study = study(folder.path(), "[{ file = 'plain.g3', units = 'furlongs' }]");
        let error = StudyRecords::read(&study).unwrap_err().to_string();
        assert_eq!(error, "study.toml: records.0.units is \"furlongs\", but must be g, m/s2, cm/s2 (gal), mm/s2, in/s2, ft/s2");
    }
}
