//! A command line that is wrong, help, and output that cannot be written.

use std::fs::File;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use super::{command, said, scene, sprag};

/// One line that begins with the name of the program and has all `words`, and exit code 2.
fn one_line(output: &Output, words: &[&str]) -> String {
    let line = said(output);
    assert_eq!(output.status.code(), Some(2), "{line}");
    assert!(line.starts_with("sprag: ") && line.ends_with('\n') && line.matches('\n').count() == 1, "one line: {line:?}");
    for word in words {
        assert!(line.contains(word), "`{word}`: {line}");
    }
    line
}

#[test]
fn a_wrong_command_line_costs_one_line_and_points_to_the_help() {
    let figure = scene("figure08");
    for (arguments, words) in [
        (&["map"] as &[&str], &["<SCENE.toml>", "see sprag map --help"] as &[&str]),
        (&["mapp"], &["'mapp'", "'map'", "see sprag --help"]),
        (&["batch", "c.csv", "--outt", "x.csv"], &["'--outt'", "'--out'", "see sprag batch --help"]),
        (&["loop", &figure, "--rate", "1"], &["'--rate'", "see sprag loop --help"]),
        (&["board", "log", "--qemu", "--port", "x"], &["'--qemu'", "'--port <DEV>'", "see sprag board log --help"]),
        (&["hil", &figure, "--qemu", "--way", "air"], &["'air'", "streams, usart"]),
        (&["hil", &figure], &["--port <DEV>", "--qemu", "--board-image"]),
        (&["board", "info"], &["--port <DEV>", "--qemu"]),
        (&["map", &figure, "--threads", "0"], &["'0'", "from 1 to 1024"]),
        (&["cloud", "study.toml", "--threads", "-1"], &["'-1'", "from 1 to 1024"]),
        (&["loop-study", "laws", "--out", "x", "--threads", "2000"], &["'2000'", "from 1 to 1024"]),
        (&["loop", &figure, "--monte-carlo", "0"], &["'0'", "from 1 to 1000000000"]),
        (&["loop", &figure, "--monte-carlo", "-5"], &["'-5'", "from 1 to 1000000000"]),
        (&["map", &figure, "--refine", "--evaluations", "-1"], &["'-1'", "from 0 to"]),
        (&["simulate", &figure, "--time-budget", "-1"], &["'-1'", "0.001"]),
        (&["design", &figure, "--teeth", "17.5"], &["'17.5'", "--teeth", "from 12 to 200"]),
        (&["accuracy", &figure, "--cells", "x"], &["'x'", "--cells", "from 0 to 64"]),
        (&["cloud", "study.toml", "--merge", "0"], &["'0'", "--merge", "from 1 to 1000000"]),
        (&["part", "parts", "x"], &["'x'", "from 1 to 1000000"]),
        (&["synthesize", "--out", "x.csv", "--seed", "-1"], &["'-1'", "--seed", "from 0 to"]),
        (&["help", "mapp"], &["'mapp'", "'map'"]),
    ] {
        let line = one_line(&sprag(arguments), words);
        assert!(!line.contains("as a value") && !line.contains("Usage") && !line.contains("error:"), "{arguments:?}: {line}");
    }
}

#[test]
fn every_message_begins_with_the_name_of_the_program() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    one_line(&sprag(&["record", &file("bad.csv", "# time_s,acc_g\n0,0\n0.01,oops\n")]), &["line 3"]);
    one_line(&sprag(&["synthesize", "--out", &file("x.csv", ""), "--rate", "10"]), &["--rate"]);
    // Velocity does not return to zero: the record is read, and something is said of it.
    let rows = (0..200).fold("# time_s,acc_g\n".to_owned(), |text, k| text + &format!("{},0.9\n", f64::from(k) * 0.01));
    let drifts = sprag(&["record", &file("drifts.csv", &rows)]);
    let lines = said(&drifts);
    assert!(drifts.status.success() && !lines.is_empty(), "{lines}");
    assert!(lines.lines().all(|line| line.starts_with("sprag: warning: ")), "{lines}");
    assert!(!String::from_utf8_lossy(&drifts.stdout).contains("warning"));
}

#[test]
fn a_file_that_is_no_port_or_no_firmware_is_named() {
    let controller = scene("controller");
    one_line(&sprag(&["board", "info", "--port", "/dev/null"]), &["/dev/null", "is not a serial port"]);
    one_line(&sprag(&["board", "info", "--port", "/dev/no-such-port"]), &["/dev/no-such-port"]);
    let itself = env!("CARGO_BIN_EXE_sprag");
    let folder = tempfile::tempdir().unwrap();
    let empty = folder.path().join("empty.elf");
    File::create(&empty).unwrap();
    for image in [itself, empty.to_str().unwrap()] {
        let arguments = ["board", "info", "--qemu", "--firmware", image];
        one_line(&sprag(&arguments), &[image, "must be an ELF file for ARM"]);
    }
    let out = folder.path().join("out");
    let arguments = ["hil", &controller, "--out", out.to_str().unwrap(), "--qemu", "--firmware", "nosuch.elf"];
    one_line(&sprag(&arguments), &["nosuch.elf", "there is no such file"]);
}

/// A linker that finds no library stands for a machine without Unicorn.
#[cfg(unix)]
#[test]
fn a_machine_without_unicorn_is_shown_what_to_install() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let linker = folder.path().join("cc");
    std::fs::write(&linker, "#!/bin/sh\nexit 1\n").unwrap();
    std::fs::set_permissions(&linker, std::fs::Permissions::from_mode(0o755)).unwrap();
    let mut line = Command::new(env!("CARGO_BIN_EXE_sprag"));
    let paths = std::env::join_paths([folder.path(), Path::new("/usr/bin"), Path::new("/bin")]).unwrap();
    line.args(["board", "info", "--board-image"]).env("PATH", paths).env_remove("UNICORN_LIB_DIR");
    one_line(&line.output().unwrap(), &["Unicorn is not installed", "libunicorn-dev"]);
}

/// The commands, those of `device` too.
const COMMANDS: [&[&str]; 23] = [
    &["simulate"],
    &["batch"],
    &["map"],
    &["cloud"],
    &["optimise"],
    &["design"],
    &["similar"],
    &["sensitivity"],
    &["accuracy"],
    &["loop"],
    &["hil"],
    &["board"],
    &["board", "info"],
    &["board", "parameters"],
    &["board", "self-test"],
    &["board", "log"],
    &["board", "clear"],
    &["board", "watch"],
    &["loop-study"],
    &["record"],
    &["synthesize"],
    &["effects"],
    &["explain"],
];

/// Lines are filled: none ends where the first word of the next would have had room.
#[test]
fn help_has_an_example_and_is_wrapped_once() {
    for command in COMMANDS {
        for columns in [70, 80, 100] {
            let help = [command, &["--help"]].concat();
            let output = super::command(&help).env("COLUMNS", columns.to_string()).output().unwrap();
            let text = String::from_utf8(output.stdout).unwrap();
            assert!(output.status.success() && text.contains(&format!("  sprag {}", command.join(" "))), "{command:?}: {text}");
            let (_, after) = text.split_once("Example").unwrap();
            let lines: Vec<&str> = after.lines().skip(1).collect();
            for pair in lines.windows(2) {
                let [line, next] = pair else { continue };
                let plain = |line: &str| !line.is_empty() && !line.starts_with(' ');
                // A table in the midst of the text begins with a line that ends early.
                let table = command == ["batch"];
                if plain(line) && plain(next) && !table {
                    let word = next.split(' ').next().unwrap();
                    let room = line.chars().count() + 1 + word.chars().count() <= columns;
                    assert!(!room, "{command:?} at {columns}: `{word}` has room after `{line}`");
                }
            }
        }
    }
}

#[test]
fn help_with_a_command_is_the_help_of_that_command() {
    for command in [&[] as &[&str], &["map"], &["board", "info"]] {
        let [asked, its_own] = [[&["help"], command].concat(), [command, &["--help"]].concat()].map(|line| sprag(&line));
        assert!(asked.status.success() && !asked.stdout.is_empty() && asked.stdout == its_own.stdout, "{command:?}");
    }
}

fn into_full(arguments: &[&str], folder: &Path) -> Output {
    let full = File::options().write(true).open("/dev/full").unwrap();
    command(arguments).current_dir(folder).stdout(full).stderr(Stdio::piped()).output().unwrap()
}

/// The commands that print results at once.
fn printing() -> Vec<Vec<String>> {
    let lines: [&[&str]; 6] = [
        &["simulate", &scene("figure05"), "--out", "out"],
        &["effects"],
        &["effects", "--json"],
        &["explain", &scene("figure05")],
        &["record", "own.csv"],
        &["map", "--help"],
    ];
    lines.map(|line| line.iter().map(|&word| word.to_owned()).collect()).to_vec()
}

#[cfg(target_os = "linux")]
#[test]
fn results_that_cannot_be_printed_are_an_error() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("own.csv"), super::pulse(0.4)).unwrap();
    for line in printing() {
        let arguments: Vec<&str> = line.iter().map(String::as_str).collect();
        let output = into_full(&arguments, folder.path());
        let errors = said(&output);
        let own: Vec<&str> = errors.lines().filter(|line| !line.starts_with("sprag: warning: ")).collect();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {errors}");
        assert!(own.len() == 1 && own[0].starts_with("sprag: standard output cannot be written: "), "{arguments:?}: {errors}");
    }
}

#[cfg(unix)]
#[test]
fn a_reader_that_has_had_enough_is_no_error() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("own.csv"), super::pulse(0.4)).unwrap();
    for line in printing() {
        let mut command = Command::new(env!("CARGO_BIN_EXE_sprag"));
        command.args(&line).current_dir(&folder).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut process = command.spawn().unwrap();
        drop(process.stdout.take());
        let output = process.wait_with_output().unwrap();
        let errors = said(&output);
        assert!(output.status.success() && errors.lines().all(|line| line.starts_with("sprag: warning: ")), "{line:?}: {errors}");
    }
}
