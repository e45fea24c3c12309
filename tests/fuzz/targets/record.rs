//! Bytes of any kind as a ground-motion record: reading may fail with one line, but never panic, and what it gives
//! must be usable.
#![no_main]

use libfuzzer_sys::{Corpus, fuzz_target};
use sprag_sim::record::{Component, ReadOptions, Record, Units};

fuzz_target!(|input: &[u8]| -> Corpus {
    // The first byte chooses what the caller knows, the rest is the file. In the seeds it is a letter.
    let Some((choice, bytes)) = input.split_first() else {
        return Corpus::Reject;
    };
    let bit = |n: u32| choice >> n & 1 == 1;
    let name = ["record.AT2", "record.smc", "record.json", "record.csv"][usize::from(choice & 3)];
    let options = ReadOptions {
        units: bit(2).then_some(Units::CentimetrePerSecondSquared),
        time_step_s: bit(3).then_some(0.005),
        component: bit(4).then(|| Component::from("x")),
        resample_to_s: bit(5).then_some(0.002),
    };
    match Record::parse(name, bytes, &options) {
        Ok(record) => {
            assert!(record.acceleration_m_s2.len() >= 2, "fewer than two samples");
            assert!(record.acceleration_m_s2.iter().all(|a| a.is_finite()), "a sample is not finite");
            assert!(record.time_step_s.is_finite() && record.time_step_s > 0.0, "time step {}", record.time_step_s);
            assert!(record.start_time_s.is_finite(), "start at {}", record.start_time_s);
            for warning in &record.warnings {
                assert!(!warning.to_string().contains('\n'), "a warning of several lines");
            }
        }
        Err(error) => assert!(!error.to_string().contains('\n'), "an error of several lines: {error}"),
    }
    Corpus::Keep
});
