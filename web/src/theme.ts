/** Dark or light: as the system has it, until a switch says otherwise; the choice is kept by the browser. */

/** What the switch offers. */
export type Theme = "system" | "light" | "dark";

const KEY = "sprag-theme";
const system = matchMedia("(prefers-color-scheme: dark)");
const subscribers = new Set<() => void>();
let theme: Theme = stored();

function stored(): Theme {
  try {
    const value = localStorage.getItem(KEY);
    return value === "light" || value === "dark" ? value : "system";
  } catch {
    // Storage is refused in some browsers' private windows.
    return "system";
  }
}

function apply(): void {
  document.documentElement.dataset["theme"] = isDark() ? "dark" : "light";
  subscribers.forEach((changed) => changed());
}

system.addEventListener("change", apply);
apply();

/** Whether the page is dark now. */
export function isDark(): boolean {
  return theme === "system" ? system.matches : theme === "dark";
}

/** What is chosen. */
export function chosenTheme(): Theme {
  return theme;
}

/** Chooses. */
export function chooseTheme(chosen: Theme): void {
  theme = chosen;
  try {
    localStorage.setItem(KEY, chosen);
  } catch {
    // It holds until the page is closed, then.
  }
  apply();
}

/** Calls `changed` whenever the page turns dark or light. */
export function onTheme(changed: () => void): void {
  subscribers.add(changed);
}
