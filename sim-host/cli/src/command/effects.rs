//! `sprag effects`: which effects there are, their keys, equations and cost.

use clap::Args;
use serde::Serialize;
use sprag_report::output::Versioned;
use sprag_report::terminal::{beside, for_terminal, room};
use sprag_sim::effect::measured::{Cost, cost};
use sprag_sim::effect::{EFFECTS, Effect, find};
use sprag_sim::keys::Key;

use super::context::{Completion, Context, Run};

/// List the effects that a scene may ask for, or show one.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag effects\n  sprag effects clutch\n  sprag effects --json\n\n\
    An effect is off until one of its keys turns it on in a scene; `sprag explain SCENE.toml` says which are on and what follows.")]
pub struct EffectsArguments {
    /// The effect to show in full.
    #[arg(value_name = "NAME")]
    pub name: Option<String>,
    /// Print JSON: an array of effects, or the one that is named.
    #[arg(long)]
    pub json: bool,
}

/// An effect as JSON.
#[derive(Serialize)]
struct Entry {
    name: &'static str,
    summary: &'static str,
    equation: &'static [&'static str],
    source: &'static str,
    keys: Vec<KeyEntry>,
    cost: Option<Cost>,
}

#[derive(Serialize)]
struct KeyEntry {
    key: &'static str,
    meaning: &'static str,
    default: String,
    range: &'static str,
}

impl KeyEntry {
    fn of(key: &'static Key) -> KeyEntry {
        KeyEntry { key: &key.path, meaning: &key.meaning, default: key.default_text(), range: &key.range }
    }
}

impl Entry {
    fn of(effect: &Effect) -> Entry {
        let keys = effect.described_keys().map(KeyEntry::of).collect();
        let Effect { name, summary, equation, source, .. } = *effect;
        Entry { name, summary, equation, source, keys, cost: cost(name) }
    }
}

impl Run for EffectsArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        let found = self.name.as_ref().map(|name| {
            let names = || EFFECTS.map(|effect| effect.name).join(", ");
            find(name).ok_or_else(|| anyhow::anyhow!("no effect \"{name}\"; there are: {}", names()))
        });
        match (found.transpose()?, self.json) {
            (None, true) => context.print_json(&EFFECTS.map(|effect| Versioned::new(Entry::of(effect)))),
            (None, false) => context.print(for_terminal(&table(room()))),
            (Some(effect), true) => context.print_json(&Versioned::new(Entry::of(effect))),
            (Some(effect), false) => context.print(for_terminal(&in_full(effect))),
        }
        Ok(Completion::Complete)
    }
}

/// What an effect costs, in words.
fn cost_in_words(name: &str) -> String {
    let Some(cost) = cost(name) else { return "not measured".to_owned() };
    let target = match cost.target_instructions.as_str() {
        "–" => String::new(),
        count => format!("; target {count} instructions"),
    };
    format!("host {} instructions, {} ns{target}", cost.host_instructions, cost.host_ns)
}

/// Every effect with its keys, their defaults and its cost; in less `room` than the columns need, a key's default and what it may be go on
/// below it.
fn table(room: usize) -> String {
    let widest = |texts: &mut dyn Iterator<Item = usize>| texts.max().unwrap_or(0);
    let keys = || EFFECTS.into_iter().flat_map(Effect::described_keys);
    let name_width = widest(&mut EFFECTS.into_iter().map(|effect| effect.name.len()));
    let key_width = widest(&mut keys().map(|key| key.path.len()));
    let default_width = widest(&mut keys().map(|key| key.default_text().len()));
    let row = |name: &str, key: &str, default: &str, allowed: &str| {
        let row = format!("{name:name_width$}  {key:key_width$}  {default:default_width$}  {allowed}");
        format!("{}\n", row.trim_end())
    };
    let beside_name = |name: &str, text: &str| beside(&format!("{name:name_width$}  "), text) + "\n";
    let key_row = |key: &Key| row("", &key.path, &key.default_text(), &key.range);
    let has_room = keys().all(|key| key_row(key).trim_end().chars().count() <= room);
    let mut text = if has_room { row("effect", "key", "default", "allowed") } else { beside_name("effect", "key") };
    for effect in EFFECTS {
        text += &format!("\n{}", beside_name(effect.name, effect.summary));
        for key in effect.described_keys() {
            text += &if has_room {
                key_row(key)
            } else {
                let more = format!("default {}; {}", key.default_text(), key.range);
                beside_name("", &key.path) + &beside(&" ".repeat(name_width + 4), &more) + "\n"
            };
        }
        text += &beside_name("", &format!("cost: {}", cost_in_words(effect.name)));
    }
    text += "\nAll are off until a key says otherwise. `sprag effects NAME` shows the equation and its source;\n\
        costs are those of docs/effects.md.\n";
    text
}

fn in_full(effect: &Effect) -> String {
    let mut text = format!("{}: {}\n\nequation\n", effect.name, effect.summary);
    for line in effect.equation {
        text += &format!("  {line}\n");
    }
    text += &format!("\nsource\n  {}\n\nkeys\n", effect.source);
    for key in effect.described_keys() {
        text += &format!("  {}\n      {}\n      default {}; {}\n", key.path, key.meaning, key.default_text(), key.range);
    }
    text + &format!("\ncost\n  {}\n", cost_in_words(effect.name))
}
