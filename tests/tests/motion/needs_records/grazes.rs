//! Clutches at a graze: what they watch touches zero, and rounding decides whether they hold.

use sprag_sim::simulation::DeviceRun;
use sprag_tests::scene_text::runs;
use sprag_tests::shared_file;

const RECORD: &str = "records/vacalderon_g3/RSN1492_CHICHI_TCU052-E.AT2.g3";

fn overrunning(record: &str, mass_ratio: f64) -> DeviceRun {
    let text = format!(
        "block = {{ size_m = 1.0, slenderness_deg = 10.0, restitution = 0.85 }}
         device = [{{ kind = 'clutched-pair', mass_ratio = {mass_ratio:?}, engagement = 'overrunning' }}]
         ground = [{{ motion = 'record', file = '{record}', time_step_s = 0.005, units = 'g' }}]
         run = {{ free_time_s = 10.0 }}"
    );
    runs(&text).remove(0)
}

/// With this mass ratio the rack of a falling block grows as fast as its flywheel and no faster; its neighbours pass by, and the motions
/// are the same.
#[test]
#[ignore = "needs the recorded motions beside the repository: run by cargo xtask test"]
fn a_flywheel_that_the_rack_just_reaches_ends_no_run() {
    let record = shared_file(RECORD);
    let record = record.to_str().unwrap();
    let [before, graze, after] = [0.232, 0.232_132_767_753_602_3, 0.2322].map(|mass_ratio| overrunning(record, mass_ratio));
    assert_eq!((before.outcome, after.outcome), (graze.outcome, graze.outcome));
    let [first, second, third] = [&before, &graze, &after].map(|run| run.first_impact_time_s.unwrap());
    assert!((first - second).abs() < 1e-2 && (third - second).abs() < 1e-2, "{first} {second} {third}");
    assert!(first.min(third) <= second && second <= first.max(third), "{first} {second} {third}");
}
