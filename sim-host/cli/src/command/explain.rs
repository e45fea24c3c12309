//! `sprag explain`: which effects a scene turns on, why, and which equations result.

use std::io::{self, Write};

use clap::Args;
use serde_json::{Value, json};
use sprag_report::output::Versioned;
use sprag_report::terminal::{for_terminal, room};
use sprag_sim::effect::explanation::{Effects, Explanation, Section, Setting};
use sprag_sim::scene::Scene;

use super::context::{Completion, Context, Run};
use super::scene_arguments::SceneArguments;

/// Columns that a line takes at most, unless a word is longer.
const WIDTH: usize = 120;

/// Show which effects a scene turns on, and its equations.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag explain scenes/near_fault.toml\n  \
    sprag explain scenes/figure05.toml --set device.1.kinematics=consistent\n\n\
    Nothing is simulated and no record is read.")]
pub struct ExplainArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Print effects and equations as JSON instead of text.
    #[arg(long)]
    pub json: bool,
}

impl Run for ExplainArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        let scene = self.scene.load(None)?;
        context.warned(scene.warnings());
        if self.json {
            context.print_json(&Versioned::new(document(&scene)));
            return Ok(Completion::Complete);
        }
        let mut text = Vec::new();
        write_scene(&scene, &mut text)?;
        context.print(for_terminal(&String::from_utf8_lossy(&text)));
        Ok(Completion::Complete)
    }
}

/// What the text says, for programs.
fn document(scene: &Scene) -> Value {
    let effects = |effects: &Effects| {
        let because = |setting: &Setting| json!({ "effect": setting.effect.name, "because": setting.keys });
        json!({ "on": effects.on.iter().map(because).collect::<Vec<_>>(), "off": effects.off })
    };
    let device = |index: usize| {
        let of = Explanation::of(scene, index);
        let section = |section: &Section| json!({ "title": section.title, "lines": section.lines });
        let sections: Vec<Value> = of.sections.iter().map(section).collect();
        json!({ "device": of.device, "kind": of.kind, "effects": effects(&of.effects), "sections": sections })
    };
    let devices: Vec<Value> = (0..scene.devices.len()).map(device).collect();
    json!({ "scene": scene.origin, "title": scene.file.title, "effects": effects(&Effects::of_scene(scene)), "devices": devices })
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

/// Writes a line by words, indented, on as many lines of [`WIDTH`] columns, or of a narrower terminal, as it takes.
fn write_folded(indent: usize, text: &str, out: &mut impl Write) -> io::Result<()> {
    let width = WIDTH.min(room());
    let mut line = " ".repeat(indent);
    let mut columns = indent;
    // Two spaces set equations apart, and are kept.
    for word in text.split(' ') {
        let length = word.chars().count();
        if columns + 1 + length > width && columns > indent {
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
