//! The cases of the target, on the host.

use sprag_shared::observers::digest::Digest;
use sprag_stability::target_cases::target_cases;

/// Each by the words that the board reads: the outcome, bounded work, a finite state, and the same bits twice.
#[test]
fn the_cases_of_the_target_end_as_they_must() {
    for target in target_cases() {
        let mut words = vec![0; 1024];
        let count = target.case.encode(&mut words).expect("few words");
        let run = || {
            let mut digest = Digest::default();
            let end = sprag_case::run(&words[..count], &mut digest).unwrap_or_else(|error| panic!("{}: {error}", target.name));
            (end, digest.hash())
        };
        let (end, hash) = run();
        println!("{}: {} after {} steps and {} impacts", target.name, end.outcome.name(), end.steps, end.state.impacts);
        assert_eq!(end.outcome, target.outcome, "{}", target.name);
        assert!(end.steps <= target.steps, "{}: {} steps, at most {} expected", target.name, end.steps, target.steps);
        assert!(end.state.rotation.is_finite() && end.state.velocity.is_finite() && end.peaks.rotation.is_finite());
        assert!(end.state.side.times(end.state.rotation) >= 0.0, "{}: below the floor", target.name);
        assert_eq!(run().1, hash, "{}: not the same bits twice", target.name);
    }
}
