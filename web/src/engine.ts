/**
 * What the page asks of the core, and what it gets: everything runs in workers, so that no call stops the animation.
 *
 * Angles in rad, lengths in m, times in s, accelerations in m/s² unless a name says otherwise. A failed call rejects with an `Error` whose
 * message is one plain line that can be shown as it is.
 */

/** A record that the user dropped or that a scene names; the page keeps it by its name. */
export interface RecordFile {
  name: string;
  bytes: Uint8Array;
  /** Whether it is a file of the user. */
  own?: boolean;
}

/** The record that the page has for the examples. */
export const SAMPLE = "near_fault.csv";

/** What a scene is made of: its TOML text, and the records that its `[[ground]]` names by `file`. */
export interface Source {
  text: string;
  records: RecordFile[];
}

/** What a scene says before it is run. */
export interface About {
  title: string;
  /** In the order of the scene. `kind`: none, inerter, clutched-pair. */
  devices: { name: string; kind: string; massRatio: number }[];
  sizeM: number;
  slendernessRad: number;
  frequencyParameter1S: number;
  restitution: number;
  upliftThresholdG: number;
  /** One plain line each; never fatal. */
  warnings: string[];
  hasController: boolean;
  /** Axes of `[map]`, null without. */
  map: { x: Axis; y: Axis | null } | null;
  /** The text with every default filled in, as JSON. */
  resolved: unknown;
}

export interface Axis {
  key: string;
  from: number;
  to: number;
  cells: number;
  scale: "linear" | "logarithmic";
}

/** A number of a scene that can be an axis of a map or a control. */
export interface Key {
  /** With dots: block.size_m, device.1.mass_ratio, ground.0.amplitude_g, controller.latency_s … */
  key: string;
  /** As in `resolved`; null where the scene does not set it. */
  value: number | null;
  unit: string;
  /** Range in words, and what the key is: texts of the schema. */
  range: string;
  description: string;
  /** Its name in this scene, where that is not the usual one. */
  words?: string;
}

/** The response of one device. At a discontinuity two samples share a time. */
export interface Response {
  device: string;
  /** As in `runs` of summary.json: outcome, peak_rotation, impacts, end_time_s, error_estimate … */
  summary: Record<string, unknown>;
  timeS: Float64Array;
  groundMS2: Float64Array;
  rotationRad: Float64Array;
  velocityRadS: Float64Array;
  accelerationRadS2: Float64Array;
  /** Forces of the first and second flywheel over the block's weight. */
  firstForceRatio: Float64Array;
  secondForceRatio: Float64Array;
  /** 0 none, 1 first, 2 second, 3 both. */
  engaged: Uint8Array;
  impactsS: Float64Array;
}

export interface Run {
  about: About;
  responses: Response[];
  /** history.csv of `sprag simulate`. */
  csv: string;
  /** history.svg of `sprag simulate`. */
  svg: string;
  /** FNV-1a over the bits of every sample, 16 hexadecimal digits. */
  digest: string;
}

/** Cells of a map of one device: outcome 0 no rocking, 1 safe, 2 overturned without impact, 3 overturned after impact. */
export interface Cells {
  device: number;
  /** Numbers of the cells: row · columns + column, rows from the lowest y. */
  cells: Uint32Array;
  outcome: Uint8Array;
  /** max |θ|/α; NaN where overturned. */
  peakRotation: Float64Array;
  /** max |θ̈|/(p²α); NaN where overturned. */
  peakAcceleration: Float64Array;
}

export interface MapAbout {
  devices: string[];
  x: Float64Array;
  /** One value, NaN, for a cut. */
  y: Float64Array;
  xKey: string;
  yKey: string | null;
}

/** Where one outcome gives way to another. */
export interface Boundary {
  left: number;
  right: number;
  /** x, y, x, y … values of the axes. */
  vertices: Float64Array;
}

/** A fault that is put in from `atS` on. */
export interface Injected {
  /** A name of `Engine.faults()`. */
  fault: string;
  atS: number;
}

/** A closed loop: one entry of every array a tick. */
export interface Loop {
  /** As in `runs` of summary.json of `sprag loop`: outcome, decisions, faults: [{time_s, code, fault}] … */
  summary: Record<string, unknown>;
  timeS: Float64Array;
  groundMS2: Float64Array;
  rotationRad: Float64Array;
  velocityRadS: Float64Array;
  push1S2: Float64Array;
  rotationEstimatedRad: Float64Array;
  velocityEstimatedRadS: Float64Array;
  pushEstimated1S2: Float64Array;
  /** 0 none, 1 first, 2 second, 3 both. */
  command: Uint8Array;
  engaged: Uint8Array;
  /** 1 where the law wants a flywheel engaged, judged by the true motion. */
  ideal: Uint8Array;
  /** Numbers of `states`. */
  state: Uint8Array;
  states: string[];
  /** Code of the fault, 0 for none. */
  fault: Uint16Array;
  /** The ideal pair without a controller. */
  idealPair: Response;
  /** Digest of the decisions, as the firmware has it, 16 hexadecimal digits. */
  digest: string;
  csv: string;
  svg: string;
}

/** What is wrong or remarkable with a record, and its intensity. */
export interface RecordAbout {
  name: string;
  format: string;
  units: string;
  timeStepS: number;
  durationS: number;
  samples: number;
  pgaMS2: number;
  pgvMS: number;
  ariasMS: number;
  warnings: string[];
}

/** A digest of one of the shipped scenes: what this page computes, and what firmware and command have. */
export interface DigestCheck {
  scene: string;
  computed: string;
  expected: string;
}

export interface Engine {
  readonly version: string;
  /** Whether the build with SIMD runs. */
  readonly simd: boolean;
  /** Workers that are alive. */
  readonly workers: number;

  examples(): Promise<{ name: string; title: string; text: string; records: RecordFile[] }[]>;
  about(source: Source): Promise<About>;
  /** Numeric keys of a scene. */
  keys(source: Source): Promise<Key[]>;
  /** The scene with settings KEY=VALUE applied, as TOML; comments and order are lost, values are not. */
  set(source: Source, settings: string[]): Promise<string>;
  record(file: RecordFile, options: { units?: string; timeStepS?: number }): Promise<RecordAbout>;
  simulate(source: Source): Promise<Run>;

  /** Fills the map of a scene, coarse cells first; `each` gets parts as they come. Rejects with AbortError by `signal`. */
  map(source: Source, each: (part: Cells) => void, signal: AbortSignal): Promise<MapAbout>;
  mapAbout(source: Source): Promise<MapAbout>;
  /** Boundaries between the outcomes of a whole map of a device. */
  boundaries(source: Source, device: number, outcome: Uint8Array, signal: AbortSignal): Promise<Boundary[]>;
  /** The scene of a cell, as TOML without `[map]`. */
  cell(source: Source, column: number, row: number): Promise<string>;

  faults(): Promise<{ name: string; text: string }[]>;
  loop(source: Source, injected: Injected[]): Promise<Loop>;
  /** The checks of trust: Figures 5 and 10 and the near-fault scene, in f32 by the controller and f64. */
  digests(): Promise<DigestCheck[]>;
}
