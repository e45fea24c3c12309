/** Sections below the block, each of which is mounted by a function of its own. */
import type { Engine } from "./engine";
import type { Store } from "./store";

/** Fills `root`, which stands in the page with its heading, and keeps it up to date by what it subscribes to. */
export type Mount = (root: HTMLElement, engine: Engine, store: Store) => void;

const views: { id: string; title: string; mount: Mount }[] = [];

/** Puts a section with the anchor `id` and a heading below those that are there. To be called while the page is loaded (`views.ts`). */
export function mountView(id: string, title: string, mount: Mount): void {
  views.push({ id, title, mount });
}

/** Builds the sections in the order of `mountView`. A section that fails says so and leaves the others alone. */
export function buildViews(main: HTMLElement, engine: Engine, store: Store): void {
  for (const { id, title, mount } of views) {
    const section = document.createElement("section");
    section.id = id;
    section.className = "card";
    const heading = section.appendChild(document.createElement("h2"));
    heading.id = `${id}-title`;
    heading.textContent = title;
    section.setAttribute("aria-labelledby", heading.id);
    const root = section.appendChild(document.createElement("div"));
    main.append(section);
    try {
      mount(root, engine, store);
    } catch (problem) {
      store.fail(problem);
    }
  }
}
