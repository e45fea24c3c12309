//! `sprag explain`: which effects a scene turns on, why, and which equations result.

use std::io::{self, Write};
use std::path::PathBuf;

use clap::Args;
use sprag_sim::effect::explanation::{Effects, Explanation};
use sprag_sim::scene::Scene;

use super::{BAD_INPUT, warned};

/// Columns that a line takes, unless a word is longer.
const WIDTH: usize = 120;

/// Show which effects a scene turns on, and its equations.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag explain scenes/near_fault.toml\n  \
    sprag explain scenes/figure05.toml --set device.1.kinematics=consistent\n\n\
    Nothing is simulated and no record is read.")]
pub struct ExplainArguments {
    /// Scene file.
    #[arg(value_name = "SCENE.toml")]
    pub scene: PathBuf,
    /// Change one value of the scene, such as block.size_m=2 or device.1.mass_ratio=0.5.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

/// Runs the command and returns its exit status: 0, or 2 after one line on `err`.
pub fn run(arguments: &ExplainArguments, out: &mut impl Write, err: &mut impl Write) -> i32 {
    let scene = match Scene::load(&arguments.scene, &arguments.set) {
        Ok(scene) => scene,
        Err(error) => {
            let _ = writeln!(err, "sprag: {error}");
            return BAD_INPUT;
        }
    };
    warned(scene.warnings(), err);
    // What keeps it from being written is reported where standard output is.
    let _ = write_scene(&scene, out);
    0
}

fn write_scene(scene: &Scene, out: &mut impl Write) -> io::Result<()> {
    if scene.file.title.is_empty() {
        writeln!(out, "{}", scene.origin)?;
    } else {
        writeln!(out, "{}: {}", scene.origin, scene.file.title)?;
    }
    writeln!(out, "\nwhole scene")?;
    write_effects(&Effects::of_scene(scene), out)?;
    for index in 0..scene.devices.len() {
        let explanation = Explanation::of(scene, index);
        writeln!(out, "\ndevice.{index}: {} (kind \"{}\")", explanation.device, explanation.kind)?;
        write_effects(&explanation.effects, out)?;
        for section in &explanation.sections {
            writeln!(out, "  {}", section.title)?;
            for line in &section.lines {
                write_folded(4, line, out)?;
            }
        }
    }
    Ok(())
}

fn write_effects(effects: &Effects, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "  effects on{}", if effects.on.is_empty() { ": none" } else { "" })?;
    for setting in &effects.on {
        write_folded(4, &format!("{}: {}", setting.effect.name, setting.effect.summary), out)?;
        write_folded(6, &format!("because {}", setting.keys), out)?;
    }
    let off = if effects.off.is_empty() { "none".to_owned() } else { effects.off.join(", ") };
    write_folded(2, &format!("effects off: {off}"), out)
}

/// Writes a line by words, indented, on as many lines of [`WIDTH`] columns as it takes.
fn write_folded(indent: usize, text: &str, out: &mut impl Write) -> io::Result<()> {
    let mut line = " ".repeat(indent);
    let mut columns = indent;
    // Two spaces set equations apart, and are kept.
    for word in text.split(' ') {
        let length = word.chars().count();
        if columns + 1 + length > WIDTH && columns > indent {
            writeln!(out, "{}", line.trim_end())?;
            line = " ".repeat(indent + 2);
            columns = indent + 2;
        } else if columns > indent {
            line.push(' ');
            columns += 1;
        }
        line.push_str(word);
        columns += length;
    }
    writeln!(out, "{}", line.trim_end())
}
