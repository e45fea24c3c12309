//! The link beside the control task.

use sprag_board_image::model::Model;
use sprag_board_image::rig::{Rig, image};
use sprag_shared::control::supervisor::Phase;
use sprag_shared::link::{Refusal, Reply, Request, WORD_BLOCK, Words};
use sprag_shared::settings::{Item, Settings};

/// B4: requests as fast as the line carries them make no tick late.
#[test]
fn requests_at_line_rate_delay_no_tick() {
    let mut rig = Rig::armed(Model::F405);
    for _ in 0..300 {
        // 46 bytes in half a millisecond: frames of seven.
        (0..6).for_each(|_| _ = rig.send(&Request::Identify));
        rig.ticks(1);
    }
    rig.ticks(2000);
    let state = rig.state();
    // Answers are longer than requests, so some of these are lost; no tick is late for that.
    assert_eq!((state.phase, state.worst_lateness), (Phase::Armed, 0));
}

/// A7: a period that the board cannot keep is refused, and the link answers as before.
#[test]
fn a_period_that_the_board_cannot_keep_is_refused() {
    let mut rig = Rig::new(&image(), Some(&Settings::default()));
    rig.boot();
    let mut settings = Settings::default();
    let first = Item::Period.index();
    settings.set(first, 1e-5_f32.to_bits()).unwrap();
    let mut words = [0; WORD_BLOCK];
    words[0] = 1e-5_f32.to_bits();
    let written = rig.ask(&Request::Write(Words { first, count: 1, words }));
    let applied = rig.ask(&Request::Apply { check: settings.check(), store: true });
    println!("write: {written:?}; apply: {applied:?}");
    assert!(matches!(applied, Reply::Refused(Refusal::TooFast { .. })), "{applied:?}");
    let Reply::Identity(identity) = rig.ask(&Request::Identify) else { panic!("no identity") };
    assert_eq!(identity.check, Settings::default().check());
}
