//! The same bits everywhere: on this machine, in the firmware (`emulated::firmware`) and in a browser (`web/tests`).

use sprag_sim::digest::{of_decisions, of_responses};
use sprag_tests::device_loop::{on_the_host, scene};
use sprag_tests::digests::digests;
use sprag_tests::shipped::runs;

#[test]
fn this_machine_has_the_bits_of_the_others() {
    let all = digests();
    assert_eq!(all.len(), 3);
    for digests in all {
        let file = format!("{}.toml", digests.scene);
        let responses = of_responses(&runs(&file, &[]));
        let decisions = of_decisions(&on_the_host(&scene(&file, &[])).0);
        assert_eq!((decisions, responses), (digests.decisions, digests.responses), "{file}: {decisions:016x} {responses:016x}");
    }
}
