/** Impacts that can be heard: a knock each, louder the faster the block comes down. Off until it is asked for. */
import type { Store } from "../store";
import { valueAt } from "./motion";

/** The sound of impacts while the page plays. */
export class Knocks {
  private audio: AudioContext | null = null;
  private knock: AudioBuffer | null = null;
  private lastS = 0;

  constructor(private readonly store: Store) {
    store.subscribe("time", () => this.listen());
  }

  /** Turns the sound on or off; browsers ask that a click of the user does it first. */
  set on(on: boolean) {
    if (on && this.audio === null) {
      this.audio = new AudioContext();
      this.knock = knockOf(this.audio);
    } else if (on) {
      void this.audio?.resume();
    } else {
      void this.audio?.suspend();
    }
  }

  private listen(): void {
    const from = this.lastS;
    const to = this.store.time;
    this.lastS = to;
    const { audio, knock, store } = this;
    // A jump by the scrubber is silent.
    if (audio === null || knock === null || audio.state !== "running" || !store.playing || to <= from || to - from > 0.2) {
      return;
    }
    const speed = (store.run?.about.frequencyParameter1S ?? 1) * (store.run?.about.slendernessRad ?? 1);
    store.run?.responses.forEach((response, index, all) => {
      const impact = response.impactsS.find((time) => time > from && time <= to);
      const pace = impact === undefined ? 0 : Math.abs(valueAt(response.timeS, response.velocityRadS, impact - 1e-6)) / speed;
      if (pace > 0.01) {
        this.play(audio, knock, Math.min(pace, 1.5) / 1.5, all.length > 1 ? (2 * index) / (all.length - 1) - 1 : 0);
      }
    });
  }

  private play(audio: AudioContext, knock: AudioBuffer, loudness: number, side: number): void {
    const source = new AudioBufferSourceNode(audio, { buffer: knock });
    source
      .connect(new GainNode(audio, { gain: loudness }))
      .connect(new StereoPannerNode(audio, { pan: 0.6 * side }))
      .connect(audio.destination);
    source.start();
  }
}

/** A short dull knock: two tones that die away. */
function knockOf(audio: AudioContext): AudioBuffer {
  const length = Math.round(0.18 * audio.sampleRate);
  const buffer = new AudioBuffer({ length, sampleRate: audio.sampleRate });
  const samples = buffer.getChannelData(0);
  for (let i = 0; i < length; i++) {
    const t = i / audio.sampleRate;
    samples[i] = 0.6 * Math.exp(-28 * t) * Math.sin(2 * Math.PI * 92 * t) + 0.3 * Math.exp(-90 * t) * Math.sin(2 * Math.PI * 410 * t);
  }
  return buffer;
}
