//! Long commands on a terminal, as a user sees them: a bar that moves, and an end by Ctrl-C that says what is kept.

use std::collections::BTreeSet;
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use portable_pty::{Child, CommandBuilder, MasterPty, PtySize, native_pty_system};

use super::{CASE_TITLES, SHORT_SCENE, command, pulse, said, scene};

/// For how long something that a test waits for may take on a busy machine.
const GUARD: Duration = Duration::from_secs(120);

/// Records whose runs outlast what a test does meanwhile, however quick the machine.
const MANY: usize = 2000;

/// A program on a terminal of its own.
struct Terminal {
    master: Box<dyn MasterPty + Send>,
    child: Box<dyn Child + Send + Sync>,
    seen: Arc<Mutex<Vec<u8>>>,
    reader: std::thread::JoinHandle<()>,
}

impl Terminal {
    fn start(columns: u16, environment: &[(&str, &str)], folder: &Path, program: &str, arguments: &[&str]) -> Terminal {
        let size = PtySize { rows: 24, cols: columns, ..PtySize::default() };
        let pair = native_pty_system().openpty(size).unwrap();
        let mut command = CommandBuilder::new(program);
        command.args(arguments);
        command.cwd(folder);
        command.env_remove("NO_COLOR");
        command.env("TERM", "xterm-256color");
        environment.iter().for_each(|(name, value)| command.env(name, value));
        let child = pair.slave.spawn_command(command).unwrap();
        drop(pair.slave);
        let seen = Arc::new(Mutex::new(Vec::new()));
        let (mut from, into) = (pair.master.try_clone_reader().unwrap(), seen.clone());
        // The other end reports an error, not an end, once the program is gone.
        let reader = std::thread::spawn(move || {
            let mut bytes = [0; 4096];
            while let Ok(count @ 1..) = from.read(&mut bytes) {
                into.lock().unwrap().extend(&bytes[..count]);
            }
        });
        Terminal { master: pair.master, child, seen, reader }
    }

    fn text(&self) -> String {
        String::from_utf8_lossy(&self.seen.lock().unwrap()).into_owned()
    }

    /// Waits until the terminal has shown something, or the program has ended.
    fn until(&mut self, shown: impl Fn(&str) -> bool) {
        let start = Instant::now();
        while !shown(&self.text()) && self.child.try_wait().unwrap().is_none() {
            if start.elapsed() > GUARD {
                self.child.kill().unwrap();
                panic!("it hangs: {}", self.text());
            }
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// As a user does it, by the key.
    fn control_c(&self) {
        self.master.take_writer().unwrap().write_all(b"\x03").unwrap();
    }

    fn terminate(&self) {
        signal("-TERM", self.child.process_id().unwrap());
    }

    /// The exit code, and all that was shown.
    fn ended(mut self) -> (u32, String) {
        self.until(|_| false);
        let code = self.child.wait().unwrap().exit_code();
        self.reader.join().unwrap();
        let text = String::from_utf8_lossy(&self.seen.lock().unwrap()).into_owned();
        (code, text)
    }
}

pub fn signal(name: &str, process: u32) {
    assert!(Command::new("kill").args([name, &process.to_string()]).status().unwrap().success());
}

fn sprag(folder: &Path, columns: u16, arguments: &[&str]) -> Terminal {
    Terminal::start(columns, &[], folder, env!("CARGO_BIN_EXE_sprag"), arguments)
}

/// What was drawn or written, one after another, without the blanks that fill a line.
fn drawn(text: &str) -> Vec<&str> {
    let parts = text.split(['\r', '\n']).map(|part| part.trim_start_matches("\x1b[2K").trim_end());
    parts.filter(|part| !part.is_empty()).collect()
}

/// The counts other than 0 that were shown, such as the 12,000 of "12,000 of 262,144 cells" and of "12,000 runs so far".
fn counts(text: &str) -> BTreeSet<u64> {
    let count = |line: &str| {
        let (before, _) = [" of ", " blocks (at most", " runs so far"].into_iter().find_map(|then| line.split_once(then))?;
        before.rsplit(' ').next()?.replace(',', "").parse().ok().filter(|count| *count > 0)
    };
    drawn(text).into_iter().filter(|line| !line.starts_with("sprag: warning: ")).filter_map(count).collect()
}

/// A bar was drawn and has moved, and something was said of time.
fn moved(text: &str) -> bool {
    counts(text).len() > 1 && (text.contains(" left") || text.contains(" so far, "))
}

/// The terminal is left as it was found: the bar is gone, the cursor is visible, and the message has a line of its own.
fn tidy(text: &str, message: &str) {
    assert!(!text.contains("\x1b[?25l") || text.rfind("\x1b[?25h") > text.rfind("\x1b[?25l"), "{text:?}");
    assert!(text.ends_with("\r\n"), "{text:?}");
    let last = text.trim_end_matches("\r\n").rsplit('\n').next().unwrap();
    let (bar, line) = last.rsplit_once("\r\x1b[2K").unwrap_or(("", last));
    assert!(line.starts_with("sprag: interrupted; ") && line.contains(message), "{line:?} after {bar:?}");
}

/// Records of `count` pulses in the folder `records`.
fn records(folder: &Path, count: usize) {
    let records = folder.join("records");
    std::fs::create_dir_all(&records).unwrap();
    for number in 0..count {
        let peak = 0.2 + 0.5 * number as f64 / count as f64;
        std::fs::write(records.join(format!("{number:03}.csv")), pulse(peak)).unwrap();
    }
}

fn cases(folder: &Path, count: usize) {
    let row = ",full,15,clutched-pair,0.5,0.85,sine,2.5,3,20\n";
    let text = (0..count).fold(CASE_TITLES.to_owned(), |text, index| text + &index.to_string() + row);
    std::fs::write(folder.join("cases.csv"), text).unwrap();
}

fn short_scene(folder: &Path) {
    std::fs::write(folder.join("short.toml"), SHORT_SCENE).unwrap();
    std::fs::write(folder.join("own.csv"), pulse(0.4)).unwrap();
}

/// A map whose cells are simulated one by one.
const ONE_BY_ONE: [&str; 2] = ["--set", "ground.0.motion=\"half-sine\""];

/// A command that is asked to stop while its bar moves; it ends as shells have it, and says what is kept.
fn stopped(folder: &Path, arguments: &[&str], by: &str, message: &str) -> String {
    let mut terminal = sprag(folder, 100, arguments);
    terminal.until(moved);
    if by == "Ctrl-C" {
        terminal.control_c()
    } else {
        terminal.terminate()
    }
    let (code, text) = terminal.ended();
    assert!(moved(&text), "{arguments:?}: {text:?}");
    assert_eq!(code, if by == "Ctrl-C" { 130 } else { 143 }, "{arguments:?}: {text:?}");
    tidy(&text, message);
    text
}

/// Work in stages, whose end is not known beforehand, says how long it has taken and nothing of what is left.
fn says_no_time_left(text: &str) {
    assert!(text.contains(" runs so far, ") && !text.contains(" left"), "{text:?}");
}

/// The same command with --resume keeps what is in the file of `rows`, also when it is stopped at once.
fn resumes(folder: &Path, arguments: &[&str], rows: &str) {
    let kept = || std::fs::read_to_string(folder.join(rows)).unwrap().lines().count();
    let before = kept();
    let mut again = sprag(folder, 100, &[arguments, &["--resume"]].concat());
    again.until(|text| !counts(text).is_empty());
    again.control_c();
    let (code, text) = again.ended();
    assert!(code == 130 && before > 1 && kept() >= before, "{} of {before} rows: {text:?}", kept());
}

/// A command that is left to do its work.
fn ends_well(folder: &Path, arguments: &[&str]) -> String {
    let (code, text) = sprag(folder, 100, arguments).ended();
    assert_eq!(code, 0, "{arguments:?}: {text:?}");
    text
}

#[test]
fn map_keeps_its_rows_and_resumes() {
    let folder = tempfile::tempdir().unwrap();
    let figure = scene("figure08");
    let map = |cells: &'static str, more: &[&'static str]| {
        let axes = ["map", &figure, "--out", "map", "--x", cells, "--y", "ground.0.amplitude_ratio=1:10:40"];
        [&axes[..], &ONE_BY_ONE, more].concat().into_iter().map(str::to_owned).collect::<Vec<_>>()
    };
    let large = map("ground.0.frequency_ratio=1:10:4000", &[]);
    let large: Vec<&str> = large.iter().map(String::as_str).collect();
    for (by, more) in [("Ctrl-C", None), ("termination", Some("--resume"))] {
        let arguments: Vec<&str> = large.iter().copied().chain(more).collect();
        let text = stopped(folder.path(), &arguments, by, "the same command with --resume continues");
        assert!(text.contains("kept"), "{text:?}");
    }
    resumes(folder.path(), &large, "map/map.csv.unfinished");
}

/// What an interrupted map says that has all its cells.
const BOUNDARIES: &str = "all rows are kept in map; the same command with --resume traces the boundaries from the start";

#[test]
fn map_with_boundaries_shows_what_it_traces() {
    let folder = tempfile::tempdir().unwrap();
    let figure = scene("figure08");
    let few = ["--set", "map.x.cells=6", "--set", "map.y.cells=5", "--refine", "--out", "map"];
    let arguments = [&["map", &figure], &few[..]].concat();
    let text = stopped(folder.path(), &arguments, "Ctrl-C", BOUNDARIES);
    assert!(text.contains("(at most 6,000,000) on boundaries so far, "), "{text:?}");
    let text = ends_well(folder.path(), &[&arguments[..], &["--evaluations", "200", "--resume"]].concat());
    assert!(text.contains("evaluations"), "{text:?}");
}

#[test]
fn cloud_keeps_its_rows_and_resumes() {
    let folder = tempfile::tempdir().unwrap();
    records(folder.path(), 4 * MANY);
    let study = scene("cloud");
    let arguments = ["cloud", &study, "--out", "cloud", "--threads", "1", "--records", "records"];
    stopped(folder.path(), &arguments, "termination", "the same command with --resume continues");
    resumes(folder.path(), &arguments, "cloud/runs.csv.unfinished");
}

#[test]
fn optimise_keeps_its_rows_and_resumes() {
    let folder = tempfile::tempdir().unwrap();
    records(folder.path(), 100);
    let study = scene("optimise");
    let arguments = ["optimise", &study, "--out", "optimise", "--threads", "1", "--records", "records"];
    says_no_time_left(&stopped(folder.path(), &arguments, "Ctrl-C", "the same command with --resume continues"));
    resumes(folder.path(), &arguments, "optimise/tried.csv.unfinished");
}

#[test]
fn commands_that_keep_no_rows_say_so() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    short_scene(path);
    records(path, MANY);
    cases(path, 400_000);
    let (controller, figure) = (scene("controller"), scene("figure10"));
    let all: Vec<String> = (0..MANY).map(|number| format!("records/{number:03}.csv")).collect();
    let mut sensitivity = vec!["sensitivity", "short.toml", "--out", "sensitivity", "--records"];
    sensitivity.extend(all.iter().map(String::as_str));
    let pair = "device.0.kind=clutched-pair";
    let mut design = vec!["design", "short.toml", "--set", "block.mass_kg=8000", "--set", pair, "--out", "design", "--records"];
    design.extend(all.iter().map(String::as_str));
    let long: [(&[&str], &str); 6] = [
        (&["batch", "cases.csv", "--out", "results.csv"], "Ctrl-C"),
        (&sensitivity, "termination"),
        (&design, "Ctrl-C"),
        (&["loop", &controller, "--monte-carlo", "100000", "--out", "loop"], "Ctrl-C"),
        (&["loop-study", "practice", "--out", "study"], "termination"),
        (&["accuracy", &figure, "--out", "accuracy"], "Ctrl-C"),
    ];
    for (arguments, by) in long {
        let text = stopped(path, arguments, by, "nothing was written");
        if ["design", "loop-study", "accuracy"].contains(&arguments[0]) {
            says_no_time_left(&text);
        }
    }
    assert!(!path.join("results.csv").exists() && !path.join("sensitivity/summary.json").exists());
    assert!(!path.join("design/summary.json").exists());
}

#[test]
fn a_batch_says_that_it_waits_for_cases() {
    let folder = tempfile::tempdir().unwrap();
    let waits = |text: &str| text.contains("waiting for cases on standard input, ");
    let mut terminal = sprag(folder.path(), 100, &["batch", "-", "--out", "results.csv"]);
    terminal.until(waits);
    terminal.control_c();
    let (code, text) = terminal.ended();
    assert!(code == 130 && waits(&text), "{code}: {text:?}");
}

#[test]
fn short_runs_end_well_on_a_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    short_scene(path);
    cases(path, 100);
    let (controller, figure) = (scene("controller"), scene("figure05"));
    ends_well(path, &["batch", "cases.csv", "--out", "results.csv"]);
    ends_well(path, &["sensitivity", "short.toml", "--out", "sensitivity"]);
    ends_well(path, &["design", "short.toml", "--set", "block.mass_kg=8000", "--out", "design"]);
    ends_well(path, &["loop", &controller, "--monte-carlo", "2", "--out", "loop"]);
    ends_well(path, &["accuracy", &figure, "--cells", "1", "--smallest-step", "0.1", "--out", "accuracy"]);
    ends_well(path, &["simulate", "short.toml", "--out", "simulate"]);
    ends_well(path, &["similar", "short.toml", "--with", "block.size_m=3", "--out", "similar"]);
    ends_well(path, &["record", "own.csv"]);
}

#[test]
fn texts_are_as_wide_as_the_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let figure = scene("figure10");
    let lines: [&[&str]; 3] = [&["effects"], &["effects", "clutch"], &["explain", &figure]];
    for line in lines {
        let (code, text) = sprag(folder.path(), 60, line).ended();
        assert_eq!(code, 0, "{line:?}: {text:?}");
        // A dot above a letter takes no column.
        let width = |line: &str| line.chars().filter(|letter| *letter != '\u{307}' && *letter != '\u{308}').count();
        // But the scene's own path, which has no spaces.
        let wide = drawn(&text).into_iter().find(|line| width(line) > 60 && !line.contains(&figure));
        assert_eq!(wide, None, "{line:?}");
    }
}

/// A map that takes a while.
fn slow_map(figure: &str) -> Vec<&str> {
    let cells = ["--set", "map.x.cells=3000", "--set", "map.y.cells=3000", "--out", "map"];
    [&["map", figure][..], &ONE_BY_ONE, &cells].concat()
}

#[test]
fn a_narrow_window_is_not_flooded() {
    let folder = tempfile::tempdir().unwrap();
    let figure = scene("figure08");
    for columns in [20, 40] {
        let mut terminal = sprag(folder.path(), columns, &[&slow_map(&figure)[..], &["--restart"]].concat());
        terminal.until(|text| text.matches(" left").count() > 2);
        let before = terminal.text();
        terminal.control_c();
        let (code, text) = terminal.ended();
        assert_eq!(code, 130, "{text:?}");
        assert!(before.contains(" left") && !before.contains('\n'), "{before:?}");
        for line in drawn(&before) {
            assert!(line.chars().count() < usize::from(columns), "{columns}: {line:?}");
        }
    }
}

#[test]
fn where_no_bar_can_be_drawn_there_are_lines() {
    let folder = tempfile::tempdir().unwrap();
    let figure = scene("figure08");
    let program = env!("CARGO_BIN_EXE_sprag");
    let mut dumb = Terminal::start(80, &[("TERM", "dumb")], folder.path(), program, &slow_map(&figure));
    dumb.until(|text| text.contains(" left\r\n"));
    dumb.terminate();
    let (code, text) = dumb.ended();
    assert_eq!(code, 143, "{text:?}");
    assert!(text.lines().all(|line| line.starts_with("sprag: ")) && !text.contains('\x1b'), "{text:?}");
    assert!(text.contains(" of 27,000,000 cells, "), "{text:?}");
}

#[test]
fn no_color_has_a_bar_without_colour() {
    let folder = tempfile::tempdir().unwrap();
    let figure = scene("figure08");
    let program = env!("CARGO_BIN_EXE_sprag");
    let mut plain = Terminal::start(80, &[("NO_COLOR", "1")], folder.path(), program, &slow_map(&figure));
    plain.until(moved);
    plain.control_c();
    let (code, text) = plain.ended();
    assert!(code == 130 && moved(&text), "{text:?}");
    let coloured = text
        .split("\x1b[")
        .skip(1)
        .any(|code| code.trim_start_matches(|c: char| c.is_ascii_digit() || c == ';').starts_with('m'));
    assert!(!coloured, "{text:?}");
}

#[test]
fn either_stream_may_go_elsewhere() {
    let folder = tempfile::tempdir().unwrap();
    let program = env!("CARGO_BIN_EXE_sprag");
    short_scene(folder.path());
    let shell = |redirection: &str, more: &str| {
        let line = format!("exec \"$0\" {more} {redirection}");
        Terminal::start(80, &[], folder.path(), "sh", &["-c", &line, program])
    };
    let file = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let run = "sensitivity short.toml --out sensitivity";
    let (code, text) = shell("> table.txt", run).ended();
    assert!(code == 0 && !file("table.txt").contains('\x1b') && file("table.txt").contains("inerter"), "{text:?}");
    assert!(!text.contains("inerter"), "{text:?}");
    let (code, text) = shell("2> errors.txt", run).ended();
    assert!(code == 0 && text.contains("inerter") && !text.contains('\x1b'), "{text:?}");
    assert!(!file("errors.txt").contains('\x1b'));
    // Lines of long work go where errors go, and nowhere else.
    records(folder.path(), 60);
    let mut long =
        shell("2> errors.txt", &format!("map {} --out map --set map.x.cells=3000 --set map.y.cells=3000", scene("figure08")));
    let shown = folder.path().join("errors.txt");
    long.until(|_| std::fs::read_to_string(&shown).is_ok_and(|text| text.contains(" of 27,000,000 cells")));
    long.control_c();
    let (code, text) = long.ended();
    assert_eq!((code, drawn(&text)), (130, vec!["^C"]));
    assert!(file("errors.txt").contains("the same command with --resume continues"), "{}", file("errors.txt"));
}

/// Work that does not look whether it shall stop, here because it waits for its input, is ended all the same.
#[test]
fn what_is_kept_is_said_even_by_work_that_does_not_look() {
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("pipe.csv");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let mut command = command(&["batch", pipe.to_str().unwrap(), "--out", "results.csv"]);
    let process = command.current_dir(&folder).stderr(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
    // There is no other end before it reads, and nothing to be read.
    let _other_end = std::fs::OpenOptions::new().write(true).open(&pipe).unwrap();
    signal("-TERM", process.id());
    let ended = process.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), Some(143), "{}", said(&ended));
    assert!(said(&ended).ends_with("sprag: interrupted; nothing was written\n"), "{}", said(&ended));
}
