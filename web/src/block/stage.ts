/** The canvas with all devices side by side: how it is divided, and what a frame draws. */
import { drawSoon } from "../clock";
import { deviceLook, surface } from "../colours";
import { el, say } from "../dom";
import type { Store } from "../store";
import { texts } from "../texts";
import { onTheme } from "../theme";
import { drawDevice } from "./draw";
import { placed, type Shape } from "./geometry";
import { fitted } from "./label";
import { motionOf, poseAt, valueAt, type Motion, type Pose } from "./motion";
import { depthM, halfSpanM, heightM, roomForGroundM } from "./room";

/** Where the devices are in the canvas (CSS px). */
interface Layout {
  width: number;
  height: number;
  columns: number;
  slotWidth: number;
  slotHeight: number;
  /** Pixels a metre. */
  scale: number;
}

const LABEL_PX = 38;

/** The canvas of the blocks. */
export class Stage {
  readonly canvas = el("canvas", { className: "stage" });
  /** What is to scale in the picture. */
  readonly legend = el("p", { className: "hint" });
  private readonly context = this.canvas.getContext("2d");
  private motion: Motion | null = null;
  private layout: Layout | null = null;
  private groundScale = 1;
  private tiltRad: number | null = null;
  private readonly pose: Pose = { rotationRad: 0, firstRad: 0, secondRad: 0, engaged: 0, overturned: false };
  private readonly draw = () => this.frame();

  constructor(private readonly store: Store) {
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", texts.page.block.waiting);
    store.subscribe("run", () => this.take());
    for (const topic of ["time", "selected"] as const) {
      store.subscribe(topic, () => drawSoon(this.draw));
    }
    onTheme(() => drawSoon(this.draw));
  }

  /** To be called once the canvas stands in the page: its parent's width is what it fills. */
  observe(parent: HTMLElement): void {
    new ResizeObserver(() => this.arrange()).observe(parent);
  }

  /** Shows all blocks at this rotation in the place of the run's; null ends it. */
  set tilt(rotationRad: number | null) {
    this.tiltRad = rotationRad;
    drawSoon(this.draw);
  }

  /** Whether the point (CSS px in the canvas) is on a block, and its height above the ground (m). */
  grab(x: number, y: number): { heightM: number } | null {
    const { motion, layout } = this;
    if (motion === null || layout === null) {
      return null;
    }
    const index = Math.floor(x / layout.slotWidth) + layout.columns * Math.floor(y / layout.slotHeight);
    const device = motion.devices[index];
    if (!device) {
      return null;
    }
    const [originX, originY, scale] = this.origin(index, device.shape, layout, motion);
    const worldX = (x - originX) / scale;
    const worldY = (originY - y) / scale;
    const { halfWidthM: b, halfHeightM: h } = device.shape;
    poseAt(device, this.store.time, this.pose);
    const [cx, cy] = placed(device.shape, this.tiltRad ?? this.pose.rotationRad, 0, h);
    // A slender block is hard to hit, above all by a finger: whatever is near its axis counts.
    const reach = Math.max(1.3 * b, 22 / scale);
    const angle = this.tiltRad ?? this.pose.rotationRad;
    const along = (worldX - cx) * Math.sin(angle) + (worldY - cy) * Math.cos(angle);
    const across = (worldX - cx) * Math.cos(angle) - (worldY - cy) * Math.sin(angle);
    return Math.abs(along) < 1.1 * h && Math.abs(across) < reach ? { heightM: Math.max(worldY, 0.4 * h) } : null;
  }

  /** Metres of a distance in the canvas (CSS px). */
  metres(pixels: number): number {
    return pixels / (this.layout?.scale ?? 1);
  }

  private take(): void {
    const { run } = this.store;
    this.motion = run && motionOf(run);
    const shape = this.motion?.devices[0]?.shape;
    this.groundScale = shape ? Math.min(1, roomForGroundM(shape) / Math.max(this.motion?.groundPeakM ?? 0, 1e-9)) : 1;
    say(this.legend, texts.page.block.legend(this.groundScale));
    if (run) {
      this.canvas.setAttribute("aria-label", texts.page.block.picture(run));
    }
    this.arrange();
  }

  private arrange(): void {
    const width = this.canvas.parentElement?.clientWidth ?? 0;
    const shape = this.motion?.devices[0]?.shape;
    if (width === 0 || !shape) {
      return;
    }
    this.layout = layoutOf(this.motion?.devices.length ?? 1, shape, width, Math.max(330, Math.min(0.6 * innerHeight, 640)));
    const ratio = Math.min(devicePixelRatio, 2);
    const [across, down] = [Math.round(width * ratio), Math.round(this.layout.height * ratio)];
    if (this.canvas.width !== across || this.canvas.height !== down) {
      this.canvas.width = across;
      this.canvas.height = down;
      this.canvas.style.height = `${this.layout.height}px`;
    }
    drawSoon(this.draw);
  }

  /** Middle of the base of a device (CSS px), pixels a metre, displacement of the ground as drawn (m). */
  private origin(index: number, shape: Shape, layout: Layout, motion: Motion): [number, number, number, number] {
    const column = index % layout.columns;
    const row = Math.floor(index / layout.columns);
    const ground = this.tiltRad === null ? valueAt(motion.groundS, motion.groundM, this.store.time) * this.groundScale : 0;
    const x = (column + 0.5) * layout.slotWidth + ground * layout.scale;
    return [x, (row + 1) * layout.slotHeight - depthM(shape) * layout.scale, layout.scale, ground];
  }

  private frame(): void {
    const { context, layout, motion, store } = this;
    if (context === null || layout === null || motion === null) {
      return;
    }
    const ratio = this.canvas.width / layout.width;
    const colours = surface();
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, layout.width, layout.height);
    motion.devices.forEach((device, index) => {
      const { shape } = device;
      const look = deviceLook(index);
      const [x, y, scale, ground] = this.origin(index, shape, layout, motion);
      poseAt(device, store.time, this.pose);
      if (this.tiltRad !== null) {
        Object.assign(this.pose, { rotationRad: this.tiltRad, engaged: 0, overturned: false, firstRad: 0, secondRad: 0 });
      }
      const left = (index % layout.columns) * layout.slotWidth;
      const top = Math.floor(index / layout.columns) * layout.slotHeight;
      context.save();
      context.beginPath();
      context.rect(left + 2, top, layout.slotWidth - 4, layout.slotHeight);
      context.clip();
      context.translate(x, y);
      context.scale(scale, -scale);
      drawDevice(context, shape, this.pose, colours, look.colour, 1 / scale, ground, layout.slotWidth / scale);
      context.restore();
      this.label(index, left, top, colours.ink, colours.muted, look.colour);
    });
  }

  private label(index: number, left: number, top: number, ink: string, muted: string, accent: string): void {
    const { context, layout, motion, store, pose } = this;
    const device = motion?.devices[index];
    const alpha = store.run?.about.slendernessRad ?? 1;
    if (context === null || !device) {
      return;
    }
    context.fillStyle = accent;
    context.fillRect(left + 6, top + 6, 12, 12);
    context.fillStyle = ink;
    context.font = `${store.selected === index ? "bold " : ""}13px system-ui, sans-serif`;
    context.fillText(fitted(context, device.response.device, (layout?.slotWidth ?? 0) - 27), left + 23, top + 17);
    context.font = "12px system-ui, sans-serif";
    context.fillStyle = muted;
    context.fillText(texts.page.block.state(pose.rotationRad / alpha, pose.overturned), left + 23, top + 33);
  }
}

/** The division of the canvas with the fewest rows among those that draw the blocks nearly as large as can be. */
function layoutOf(count: number, shape: Shape, width: number, mostHeight: number): Layout {
  const layouts: Layout[] = [];
  for (let columns = 1; columns <= count; columns++) {
    const rows = Math.ceil(count / columns);
    const slotWidth = width / columns;
    const room = mostHeight / Math.min(rows, 3) - LABEL_PX;
    const scale = Math.min(slotWidth / (2 * halfSpanM(shape)), room / heightM(shape));
    const slotHeight = scale * heightM(shape) + LABEL_PX;
    layouts.push({ width, height: rows * slotHeight, columns, slotWidth, slotHeight, scale });
  }
  const largest = Math.max(...layouts.map(({ scale }) => scale));
  return (
    layouts.findLast(({ scale }) => scale >= 0.8 * largest) ?? {
      width,
      height: mostHeight,
      columns: 1,
      slotWidth: width,
      slotHeight: mostHeight,
      scale: 1,
    }
  );
}
