/** English texts of the page around the views. */
import type { Run } from "../../engine";

const OUTCOMES: Record<string, string> = {
  safe: "stands",
  "no-rocking": "does not rock",
  "overturned-without-impact": "overturns without an impact",
  "overturned-after-impact": "overturns after an impact",
};

const outcome = (name: string) => OUTCOMES[name] ?? name.replaceAll("-", " ");

/** What the page says. Functions put values into a sentence. */
export const page = {
  language: "en",
  title: "Sprag: rocking blocks with inerters and clutches",
  tagline: "A rigid block rocks in an earthquake. Flywheels, coupled by a clutch only while they resist, keep it from falling.",
  local: "Everything is computed on this machine, by the same code as in the firmware. Nothing leaves it.",
  theme: { label: "Colours", system: "as the system", light: "light", dark: "dark" },
  loading: "The core is being loaded …",
  noEngine: (why: string) => `The core could not be started: ${why}`,
  frameFailed: (why: string) => `Something went wrong on this page: ${why}`,
  dismiss: "Dismiss",
  warnings: "Remarks on this scene",
  working: "computing …",
  outcome,

  block: {
    heading: "Block",
    waiting: "Rocking blocks; the first run is being computed",
    handle: "Rocking blocks: arrow keys tilt them, Enter lets go, Space plays and pauses",
    hint: "Drag a block to tilt it and let go. Keys: ← → tilt, Enter lets go, Space plays.",
    tilted: (ratio: number) =>
      `Held at θ/α = ${ratio.toFixed(2)}${Math.abs(ratio) > 1 ? ", beyond the tip" : ""}. Let go, or press Enter; Escape puts it back.`,
    state: (ratio: number, overturned: boolean) => (overturned ? "overturned" : `θ/α = ${ratio.toFixed(2)}`),
    picture: (run: Run) =>
      `${run.about.title || "Scene"}. ${run.responses
        .map(({ device, summary }) => {
          const peak = summary["peak_rotation"];
          return `${device}: ${outcome(String(summary["outcome"]))}${typeof peak === "number" ? `, peak rotation ${peak.toFixed(2)} of α` : ""}`;
        })
        .join("; ")}.`,
    legend: (ground: number) =>
      `To scale${ground < 0.995 ? `, but the ground moves at 1 : ${(1 / ground).toFixed(1)}` : ""}. A flywheel is a plate of the block's material and thickness with σ times its mass; filled: engaged, hollow: free.`,
    preview: "This is another block than that of the scene.",
    fix: "Make it the scene",
    unplay: "Back to the scene",
    free: "The block rocks freely, without ground motion.",
    shake: "Shake it again",
  },

  transport: {
    play: "Play",
    pause: "Pause",
    previous: "◂ Event",
    next: "Event ▸",
    speed: "Speed",
    time: "Time",
    seconds: (time: number) => `${time.toFixed(2)} seconds`,
    sound: "Sound of impacts",
    event: (device: string, kind: "impact" | 0 | 1 | 2 | 3, time: number) => {
      const what =
        kind === "impact"
          ? "impact"
          : kind === 0
            ? "no flywheel engaged"
            : kind === 1
              ? "first flywheel engaged"
              : kind === 2
                ? "second flywheel engaged"
                : "both flywheels engaged";
      return `${device}: ${what} at ${time.toFixed(4)} s`;
    },
    noEvent: (device: string) => `${device}: no event further on`,
  },

  results: {
    caption: "Results; the chosen device's clutch and impacts are marked in the histories",
    slides: (device: string, fromS: number, mostM: number, endM: number) =>
      `${device}: the base slides from ${fromS.toFixed(3)} s on: ${mostM.toFixed(4)} m at most, ${endM.toFixed(4)} m at the end. The picture does not show it.`,
    columns: ["Device", "Outcome", "Peak θ/α", "Impacts", "Clutch switches", "Peak F/(mg)"],
  },

  controls: {
    heading: "Controls",
    example: "Example",
    own: "this scene",
    start: "A block that nearly falls",
    size: "Size R (m)",
    slenderness: "Slenderness α (°)",
    restitution: "Restitution η",
    restitutionWord: (word: string) => `Restitution is "${word}"; a number here replaces it.`,
    block: "Block",
    devices: "Devices",
    massRatio: "Mass ratio σ of all devices",
    mount: "Mount",
    mounts: { "centre-of-mass": "at the centre of mass", "tying-point": "at a tying point", "base-corners": "at the base corners" },
    engagement: "Clutch",
    engagements: { ideal: "ideal (the paper's)", rigid: "rigid, with coasting flywheels", overrunning: "one-way (sprag)" },
    mountHeight: "Height of the tying point (m)",
    kinds: { none: "unprotected", inerter: "inerter", "clutched-pair": "clutched pair" },
    add: "Add",
    addDevice: "Add a device",
    remove: (name: string) => `Remove ${name}`,
    ground: "Ground motion",
    motion: "Motion",
    motions: {
      none: "none (free rocking)",
      sine: "sine, one cycle",
      cosine: "cosine, one cycle",
      "half-sine": "half sine",
      ricker: "Ricker wavelet",
      rectangular: "rectangular pulse",
      "mavroeidis-papageorgiou": "Mavroeidis-Papageorgiou",
      record: "record",
    },
    amplitude: "Amplitude (m/s²)",
    velocity: "Velocity amplitude (m/s)",
    frequency: "Frequency (Hz)",
    duration: "Duration (s)",
    scale: "Scale",
    file: "Record",
    several: (count: number) => `The scene has ${count} ground motions; these controls are those of the first.`,
    initial: "Rotation at the start θ/α",
  },

  records: {
    heading: "Own files",
    drop: "Drop a record or a scene (.toml) anywhere on this page, or choose files. Of records, PEER AT2, USGS SMC, SimCenter JSON, CSV and plain text are read. They stay on this machine.",
    choose: "Choose files …",
    units: "Units",
    asFile: "as the file says",
    step: "Time step (s), if the file has none",
    again: "Read it again",
    tooLarge: (name: string, megabytes: number, most: number) =>
      `${name} has ${megabytes.toFixed(0)} MB; this page takes records of up to ${most} MB. \`sprag\` on the command line takes larger ones.`,
    unreadable: (name: string, why: string) => `${name} cannot be read: ${why}`,
    needs: (name: string, line: string) => `${name}: ${line} Say it here and read the file again.`,
    about: (name: string, format: string, units: string, samples: number, step: number, pga: number, pgv: number) =>
      `${name}: ${format}, ${units}, ${samples} samples of ${step} s, PGA ${(pga / 9.80665).toFixed(3)} g, PGV ${pgv.toFixed(3)} m/s`,
    here: "The scene is shaken by",
    dropping: "Drop a record to shake the block by it, or a scene to open it",
  },

  histories: {
    heading: "Histories",
    ground: "Ground acceleration (g)",
    rotation: "Rotation θ/α",
    velocity: "Angular velocity θ̇/(pα)",
    force: "Force of the flywheels / weight",
    time: "Time (s)",
    legend: (device: string) => `Tints: first (blue) or second (yellow) flywheel of ${device} engaged. Ticks: its impacts.`,
    chart: (name: string) => `${name} over time; the values are in history.csv`,
    hint: (isSlender: boolean) =>
      `Click or drag in a chart to move in time. Dashed in the first: ±${isSlender ? "gα" : "g tan α"}, from which on a block at rest is lifted, on rigid ground that does not move vertically and where it does not slide.`,
  },

  scene: {
    heading: "Scene",
    edit: "The scene as TOML; a change is computed at once",
    copy: "Copy",
    copied: "Copied",
    copyFailed: "The browser does not let this page copy; select the text and copy it yourself.",
    paste: "Paste",
    pasteFailed: "The browser does not let this page paste; paste into the text yourself.",
    link: "Copy link",
    linkRecords: "The link has the scene, but not its own record: whoever opens it needs the file too.",
    tooLong: "The scene is too long for an address; hand on the file instead.",
    broken: "The address of this page has no scene that can be read (it may have been cut off); here is the first example instead.",
    download: "Download",
    toml: "scene.toml",
    csv: "history.csv",
    svg: "history.svg",
    png: "history.png",
    pngFailed: "The browser could not draw the picture as PNG; the SVG has the same.",
    command: "Run this with sprag",
    python: "Run this with Python",
    digest: "Digest of this run",
  },
};
