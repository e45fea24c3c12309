//! Errors that are reported for devices with a memory.

use super::runs_of;

#[test]
fn an_error_as_wanted_is_no_larger() {
    for (amplitude, wanted) in [(3.5, 1e-6), (4.0, 1e-6), (4.0, 1e-4), (2.0, 1e-8)] {
        let run = runs_of(&format!(
            "block = {{ size_m = 2.0, slenderness_deg = 10.0 }}\n\
             device = [{{ kind = 'clutched-pair', mass_ratio = 0.5, engagement = 'rigid' }}]\n\
             ground = [{{ motion = 'sine', amplitude_ratio = {amplitude}, frequency_hz = 1.5 }}]\n\
             run.free_time_s = 5.0\n\
             accuracy.level = {wanted:e}\n"
        ))
        .remove(0);
        let error = run.error.unwrap();
        let relative = error.estimate.of_peak(run.peak_rotation).unwrap();
        assert!(error.as_wanted && relative <= wanted, "{amplitude}: {relative:e} for {wanted:e}, {error:?}");
    }
}
