/** Colours of devices and flywheels: those of the pictures that `sprag` writes, by Okabe and Ito, made lighter where the page is dark. */
import { isDark } from "./theme";

/** How the curves of a device look. */
export interface Look {
  colour: string;
  dashes: number[];
}

// Yellow is left out: it vanishes on white.
const LIGHT = ["#000000", "#d55e00", "#0072b2", "#009e73", "#cc79a7", "#56b4e9", "#e69f00"];
const DARK = ["#f0f0f0", "#f0803c", "#4aa8e0", "#26c496", "#dd94bd", "#8ecdf2", "#f2b84b"];
const DASHES = [[], [6, 2.5], [10, 2.5, 1.5, 2.5], [1.8, 1.8], [14, 4]];

/** The look of the device at `index`. */
export function deviceLook(index: number): Look {
  const colours = isDark() ? DARK : LIGHT;
  return { colour: colours[index % colours.length] ?? "", dashes: DASHES[index % DASHES.length] ?? [] };
}

/** Behind curves while the first or second flywheel is engaged. */
export function flywheelTint(flywheel: 1 | 2): string {
  const tints = isDark() ? ["#1d3a52", "#4d3b17"] : ["#cde2f3", "#fdeed0"];
  return tints[flywheel - 1] ?? "";
}

/** An engaged flywheel itself. */
export function flywheelBar(flywheel: 1 | 2): string {
  return ["#3e7cb1", "#e2a030"][flywheel - 1] ?? "";
}

/** Text, lines and surfaces of drawings. */
export interface Surface {
  ink: string;
  muted: string;
  guide: string;
  ground: string;
  block: string;
  metal: string;
  page: string;
}

const LIGHT_SURFACE: Surface = {
  ink: "#222222",
  muted: "#595959",
  guide: "#d0d0d0",
  ground: "#5a5a5a",
  block: "#e3ddd2",
  metal: "#c3c9cf",
  page: "#ffffff",
};
const DARK_SURFACE: Surface = {
  ink: "#e8e8e8",
  muted: "#a8adb3",
  guide: "#3a4047",
  ground: "#9a9fa5",
  block: "#514c44",
  metal: "#5c656e",
  page: "#1b1f24",
};

/** Colours of drawings in the present theme. */
export function surface(): Surface {
  return isDark() ? DARK_SURFACE : LIGHT_SURFACE;
}
