//! Studies over many records, and what they find.

use std::path::PathBuf;

use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sprag_sim::scene::text_of;
use sprag_sim::simulation::RunError;
use sprag_studies::accuracy_study::report::row_table;
use sprag_studies::accuracy_study::row::RowText;
use sprag_studies::accuracy_study::study::{CELLS, Extent, SMALLEST_STEPS, check, study as accuracy_study};
use sprag_studies::cloud::findings::Findings;
use sprag_studies::cloud::records::{StudyRecord, StudyRecords};
use sprag_studies::cloud::runs::Runs;
use sprag_studies::cloud::study::Study as CloudStudy;
use sprag_studies::cloud::typed_tables::{demand_table, fragility_table, ranking_table, runs_table};
use sprag_studies::optimise::findings::Findings as Designs;
use sprag_studies::optimise::problem::{Choices, Problem};
use sprag_studies::optimise::typed_tables::{design_table, motion_table};

use crate::columns::{self, Columns};
use crate::errors::{Raise as _, by_argument, failed, missing, range, refused};
use crate::long_call::long_call;
use crate::scene::{Named, Scene};
use crate::threads;
use crate::value::whole;

/// A study: records, structures, devices, and what is asked of them; every value within its range.
#[pyclass(frozen, module = "sprag._core")]
pub struct Study {
    study: CloudStudy,
    /// Records in memory, in the place of the study's.
    given: Option<Vec<StudyRecord>>,
}

#[pymethods]
impl Study {
    /// Of a TOML text. `changes` (KEY=VALUE) are those of its scene; `files` or `records` take the place of its records.
    #[new]
    #[pyo3(signature = (text, *, folder, origin, changes, files, records))]
    fn new(
        py: Python<'_>,
        text: &str,
        folder: PathBuf,
        origin: &str,
        changes: Vec<String>,
        files: Vec<PathBuf>,
        records: Option<Named>,
    ) -> PyResult<Study> {
        let given = records.map(|records| {
            let of = |record: sprag_sim::record::Record| StudyRecord::of(record.name.clone(), record, None);
            crate::scene::records(py, &records).into_iter().map(of).collect::<Vec<_>>()
        });
        let files = match &given {
            Some(records) if records.is_empty() => return Err(missing("records", "one record or more")),
            Some(records) => records.iter().map(|record| PathBuf::from(&record.name)).collect(),
            None => files,
        };
        let study = CloudStudy::parse(text, origin, &folder, &changes, &files).map_err(|error| error.raise())?;
        Ok(Study { study, given })
    }

    /// The text of a file.
    #[staticmethod]
    fn text(path: PathBuf) -> PyResult<String> {
        text_of(&path).map_err(|error| error.raise())
    }

    /// Names of the devices.
    #[getter]
    fn devices(&self) -> Vec<String> {
        self.study.devices.clone()
    }

    /// Names of the structures.
    #[getter]
    fn structures(&self) -> Vec<String> {
        self.study.structures.iter().map(|structure| structure.name.clone()).collect()
    }

    /// What looks like a mistake, a line each.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.study.warnings()
    }
}

impl Study {
    /// Its records, one at least.
    fn records(&self) -> PyResult<StudyRecords> {
        let records = match &self.given {
            Some(given) => StudyRecords { records: given.clone(), ..StudyRecords::default() },
            None => StudyRecords::read(&self.study).map_err(|error| error.raise())?,
        };
        if records.records.is_empty() {
            let unreadable = records.unreadable.first().map(|line| by_argument(line));
            return Err(missing("records", unreadable.as_deref().unwrap_or("one record or more")));
        }
        Ok(records)
    }

    /// What is said of them.
    fn say(&self, dict: &Bound<'_, PyDict>, more: Vec<String>, records: &StudyRecords, left_out: &[String]) -> PyResult<()> {
        let here = |lines: &[String]| lines.iter().map(|line| by_argument(line)).collect::<Vec<_>>();
        let warnings = [more, self.study.warnings(), here(&records.every_warning())].concat();
        dict.set_item("warnings", warnings)?;
        dict.set_item("unreadable", here(&records.unreadable))?;
        dict.set_item("left_out", left_out)
    }
}

fn stopped(error: RunError) -> PyErr {
    error.raise()
}

/// Demands and fragilities of a study: a dict of tables, and its findings as JSON.
///
/// # Errors
/// `InputError` for a study of no records.
#[pyfunction]
#[pyo3(signature = (study, *, threads = None))]
pub fn cloud<'py>(py: Python<'py>, study: &Study, threads: Option<&Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyDict>> {
    let pool = self::threads(threads)?;
    let made = long_call(py, |interrupt| {
        pool.install(|| -> PyResult<_> {
            let records = study.records()?;
            let runs = Runs::of(&study.study, &records.records, interrupt, |_| (), &|| ()).map_err(stopped)?;
            let findings = Findings::of(&study.study, &runs, interrupt);
            if interrupt.is_set() {
                return Err(PyKeyboardInterrupt::new_err(()));
            }
            let findings = findings.map_err(failed)?;
            let tables = [
                ("runs", Columns::of(&runs_table(&study.study, &records.records, &runs.all))),
                ("demand", Columns::of(&demand_table(&findings))),
                ("fragility", Columns::of(&fragility_table(&findings))),
                ("ranking", Columns::of(&ranking_table(&findings))),
            ];
            let findings = serde_json::to_string(&findings).map_err(refused)?;
            let worst = serde_json::to_string(&runs.worst).map_err(refused)?;
            Ok((records, tables, findings, worst, runs.left_out))
        })
    })?;
    let (records, tables, findings, worst, left_out) = made?;
    let dict = columns::tables(py, tables)?;
    dict.set_item("findings", findings)?;
    dict.set_item("accuracy", worst)?;
    study.say(&dict, Vec::new(), &records, &left_out)?;
    Ok(dict)
}

/// The device of a study that overturns least within its limits: a dict of tables, and its findings as JSON.
///
/// # Errors
/// `InputError` for a study that asks for no device, or has no records.
#[pyfunction]
#[pyo3(signature = (study, *, threads = None))]
pub fn optimise<'py>(py: Python<'py>, study: &Study, threads: Option<&Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyDict>> {
    let pool = self::threads(threads)?;
    let made = long_call(py, |interrupt| {
        pool.install(|| -> PyResult<_> {
            let choices = Choices::of(&study.study).map_err(|error| error.raise())?;
            let records = study.records()?;
            let problem = Problem::new(choices, &records.records);
            if problem.motions.is_empty() {
                return Err(missing("records", problem.left_out.first().map_or("a motion", String::as_str)));
            }
            let solution = problem.solve(&mut (), interrupt, &|_| (), &|_| ()).map_err(stopped)?;
            if solution.designs.iter().all(|design| design.score.motions == 0) {
                let first = solution.failures.first().cloned().unwrap_or_default();
                return Err(failed(format_args!("no device could be tried; {first}")));
            }
            let findings = Designs::of(&problem, &solution);
            let tables = [
                ("designs", Columns::of(&design_table(&findings))),
                ("motions", Columns::of(&motion_table(&problem, &solution, findings.best.as_ref()))),
            ];
            let left_out = [&problem.choices.left_out[..], &problem.left_out, &solution.failures].concat();
            let worst = serde_json::to_string(&solution.worst).map_err(refused)?;
            let findings = serde_json::to_string(&findings).map_err(refused)?;
            Ok((tables, findings, worst, left_out, problem.choices.warnings(), records))
        })
    })?;
    let (tables, findings, worst, left_out, of_mounts, records) = made?;
    let dict = columns::tables(py, tables)?;
    dict.set_item("findings", findings)?;
    dict.set_item("accuracy", worst)?;
    study.say(&dict, of_mounts, &records, &left_out)?;
    Ok(dict)
}

/// What methods, steps and precisions cost and err over a scene of ideal devices, as a table.
///
/// # Errors
/// `InputError` for a scene with anything else.
#[pyfunction]
#[pyo3(signature = (scene, *, cells, smallest_step, threads = None))]
pub fn accuracy<'py>(
    py: Python<'py>,
    scene: &Scene,
    cells: &Bound<'py, PyAny>,
    smallest_step: f64,
    threads: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let pool = self::threads(threads)?;
    let allowed = format!("from {} to {}", CELLS.start(), CELLS.end());
    let Some(cells) = u8::try_from(whole(cells, "cells", &allowed)?).ok().filter(|cells| CELLS.contains(cells)) else {
        return Err(range("cells", cells, &allowed));
    };
    if !SMALLEST_STEPS.contains(&smallest_step) {
        return Err(range(
            "smallest_step",
            smallest_step,
            &format!("from {} to {}", SMALLEST_STEPS.start(), SMALLEST_STEPS.end()),
        ));
    }
    let scene = &scene.scene;
    check(scene).map_err(|error| error.raise())?;
    let made = long_call(py, |interrupt| {
        pool.install(|| -> PyResult<_> {
            let ground = scene.ground_motions().map_err(|error| error.raise())?;
            let progress = sprag_report::progress::Progress::new("runs");
            let extent = Extent { cells: cells.into(), smallest_step };
            let rows = accuracy_study(scene, &ground, extent, None, &progress, interrupt).map_err(|error| error.raise())?;
            let texts: Vec<RowText<'_>> = rows.iter().map(|row| row.text(&scene.devices[row.device].name)).collect();
            Columns::of(&row_table(&texts)).map_err(failed)
        })
    })?;
    made?.dict(py)
}
