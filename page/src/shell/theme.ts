// SPDX-License-Identifier: Apache-2.0
import { h } from "./h";

const themes = ["system", "light", "dark"] as const;
type Theme = (typeof themes)[number];
const symbols: Record<Theme, string> = { system: "◐", light: "☀", dark: "☾" };

function stored(): Theme {
  return themes.find((theme) => theme === localStorage.getItem("theme")) ?? "system";
}

const prefersDark = matchMedia("(prefers-color-scheme: dark)");

function apply(theme: Theme): void {
  const isDark = theme === "dark" || (theme === "system" && prefersDark.matches);
  document.documentElement.dataset.theme = isDark ? "dark" : "light";
  document.dispatchEvent(new Event("themechange"));
}

/** A button that cycles through the system's theme, light and dark. */
export function themeButton(): HTMLButtonElement {
  const button = h("button.icon.theme-button", { onclick: () => show(following()) });
  const following = () => themes[(themes.indexOf(stored()) + 1) % themes.length]!;
  const show = (theme: Theme) => {
    localStorage.setItem("theme", theme);
    button.textContent = symbols[theme];
    button.title = `Theme: ${theme}. Press for ${following()}.`;
    button.setAttribute("aria-label", button.title);
    apply(theme);
  };
  show(stored());
  prefersDark.addEventListener("change", () => apply(stored()));
  return button;
}

/** Calls at once and after each change of the theme, to fetch the colours for canvases. */
export function onTheme(listener: () => void): () => void {
  document.addEventListener("themechange", listener);
  listener();
  return () => document.removeEventListener("themechange", listener);
}

/** A colour of the theme, as in colour("accent"). */
export function colour(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}
