/** A map as files: a table and pictures. */
import { button, download, el } from "../dom";
import { downloadPng } from "../scene/png";
import type { Store } from "../store";
import { texts } from "../texts";
import type { Filling } from "./filling";
import { mapSvg } from "./picture";
import type { Sheet } from "./sheet";
import { mapCsv } from "./table";

const words = texts.views.map;

/** A map that is shown. */
export interface ShownMap {
  title: string;
  filling: Filling;
  sheet: Sheet;
}

/** Buttons that give the map of `shown` as files. */
export function mapDownloads(store: Store, shown: () => ShownMap | null): HTMLElement {
  const file = (name: string, give: (map: ShownMap) => void): HTMLButtonElement =>
    button(name, () => {
      const map = shown();
      if (map !== null) {
        give(map);
      }
    });
  const svg = ({ title, sheet }: ShownMap): string => mapSvg(title, sheet.panels, sheet.legend);
  return el(
    "span",
    { className: "buttons" },
    file(words.csv, ({ filling }) => download(words.csv, mapCsv(filling), "text/csv")),
    file(words.svg, (map) => download(words.svg, svg(map), "image/svg+xml")),
    file(words.png, (map) => downloadPng(store, words.png, svg(map))),
  );
}
