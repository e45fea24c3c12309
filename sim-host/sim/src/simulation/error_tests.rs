//! Errors that are reported for devices with a memory.

use super::runs_of;

/// A clutched pair with `clutch`, under one sine of `amplitude`, has an error no larger than `wanted`.
fn assert_as_wanted(clutch: &str, amplitude: f64, wanted: f64) {
    let run = runs_of(&format!(
        "block = {{ size_m = 2.0, slenderness_deg = 10.0 }}\n\
         device = [{{ kind = 'clutched-pair', mass_ratio = 0.5, {clutch} }}]\n\
         ground = [{{ motion = 'sine', amplitude_ratio = {amplitude}, frequency_hz = 1.5 }}]\n\
         run.free_time_s = 5.0\n\
         accuracy.level = {wanted:e}\n"
    ))
    .remove(0);
    let error = run.error.unwrap();
    let relative = error.estimate.of_peak(run.peak_rotation).unwrap();
    assert!(error.as_wanted && relative <= wanted, "{clutch}, {amplitude}: {relative:e} for {wanted:e}, {error:?}");
}

#[test]
fn an_error_as_wanted_is_no_larger() {
    for (amplitude, wanted) in [(3.5, 1e-6), (4.0, 1e-6), (4.0, 1e-4), (2.0, 1e-8)] {
        assert_as_wanted("engagement = 'rigid'", amplitude, wanted);
    }
}

/// The steps of the second method pass over a peak of the acceleration, which says nothing about that of the rotation.
#[test]
fn a_coarse_second_method_leaves_what_it_confirms() {
    for wanted in [1e-6, 1e-8] {
        assert_as_wanted("clutch = { stiffness_ratio = 3000.0, damping_ratio = 0.1, backlash_m = 0.001 }", 2.0, wanted);
    }
}
