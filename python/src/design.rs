//! Parts lists.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use sprag_sim::scene::Scene as SimScene;
use sprag_sim::scene::ground::GroundError;
use sprag_studies::cloud::record_name::names;
use sprag_studies::design::basis::Basis;
use sprag_studies::design::error::DesignError;
use sprag_studies::design::page::page;
use sprag_studies::design::study::Problem;
use sprag_studies::design::table::{delay_table, motion_table, parts_table};
use sprag_studies::sensitivity::motion::{RecordFiles, StudyMotion};

use crate::columns::{self, Columns};
use crate::errors::{Raise as _, assumption, by_assumption, missing, range, refused};
use crate::long_call::long_call;
use crate::run::warnings;
use crate::scene::{Named, Scene};
use crate::threads;

/// What is assumed, by the words of [`Basis`]; a stress of None is that of `scene`.
fn assumed(scene: &SimScene, words: &Bound<'_, PyDict>) -> PyResult<Basis> {
    let word = |name: &str| words.as_any().get_item(name);
    // What is no number is outside every range.
    let number = |name: &str| PyResult::Ok(word(name)?.extract().unwrap_or(f64::NAN));
    let stress = "allowable_stress_mpa";
    let basis = Basis {
        margin: number("margin")?,
        service_factor: number("service_factor")?,
        teeth: word("teeth")?.extract().unwrap_or(0),
        face_width_modules: number("face_width_modules")?,
        allowable_stress_mpa: if word(stress)?.is_none() { Basis::allowable_stress_of(scene) } else { number(stress)? },
        tolerance: number("tolerance")?,
    };
    match basis.check() {
        Err(DesignError::Range { option, range: allowed, .. }) => {
            let key = assumption(option);
            Err(range(&key, word(&key)?, allowed))
        }
        checked => checked.map(|()| basis).map_err(|error| error.raise()),
    }
}

/// The own motion of `scene`, and each of `records` in its place.
fn motions(scene: &SimScene, records: Vec<sprag_sim::record::Record>) -> Result<Vec<StudyMotion>, GroundError> {
    if !records.is_empty() {
        StudyMotion::may_be_replaced(scene)?;
    }
    let mut motions: Vec<StudyMotion> = StudyMotion::own(scene)?.into_iter().collect();
    let files = RecordFiles::horizontal(&records.iter().map(|record| PathBuf::from(&record.name)).collect::<Vec<_>>());
    // Records in memory are known by their names alone.
    let unnamed: Vec<_> = files.iter().map(|files| files.unnamed(files.horizontal.clone())).collect();
    for ((record, files), name) in records.into_iter().zip(&files).zip(names(&unnamed)) {
        let mut motion = StudyMotion::record(&SimScene { given: [record.into()].into(), ..scene.clone() }, files)?;
        motion.name = name;
        motions.push(motion);
    }
    Ok(motions)
}

/// Parts of every device of a scene that has a flywheel: a dict of tables, the page, and the findings as JSON.
///
/// # Errors
/// `InputError` for an assumption outside its range, and a scene that cannot be designed; `RunError` where nothing asks for a size.
#[pyfunction]
#[pyo3(signature = (scene, *, records, devices, basis, threads = None))]
pub fn design<'py>(
    py: Python<'py>,
    scene: &Scene,
    records: Named,
    devices: Vec<String>,
    basis: &Bound<'py, PyDict>,
    threads: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let pool = self::threads(threads)?;
    let scene = &scene.scene;
    let basis = assumed(scene, basis)?;
    let records = crate::scene::records(py, &records);
    let made = long_call(py, |interrupt| {
        pool.install(|| -> PyResult<_> {
            let problem = Problem::new(scene, &devices, basis).map_err(|error| error.raise())?;
            let motions = motions(scene, records).map_err(|error| error.raise())?;
            if motions.is_empty() {
                return Err(missing("records", "one record or more, or a motion of the scene"));
            }
            let findings = problem.solve(&motions, interrupt, &|_| (), &|| ()).map_err(|error| error.raise())?;
            let tables = [
                ("parts", Columns::of(&parts_table(&findings))),
                ("motions", Columns::of(&motion_table(&findings, &motions, problem.mass_kg()))),
                ("delays", Columns::of(&delay_table(&findings))),
            ];
            let read: Vec<_> = motions.iter().flat_map(|motion| motion.records.iter().cloned()).collect();
            let page = page(&problem, &findings, motions.len(), 0);
            let texts = [serde_json::to_string(&findings.lists), serde_json::to_string(&findings.worst)];
            let left_out: Vec<String> = findings.left_out.iter().map(|line| by_assumption(line)).collect();
            Ok((tables, page, texts, findings.failed, left_out, warnings(scene, &read)))
        })
    })?;
    let (tables, page, [lists, worst], failures, left_out, warnings) = made?;
    let dict = columns::tables(py, tables)?;
    dict.set_item("page", page)?;
    dict.set_item("findings", lists.map_err(refused)?)?;
    dict.set_item("accuracy", worst.map_err(refused)?)?;
    dict.set_item("warnings", warnings)?;
    dict.set_item("failed", failures)?;
    dict.set_item("left_out", left_out)?;
    Ok(dict)
}
