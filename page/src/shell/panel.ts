// SPDX-License-Identifier: Apache-2.0
import type { Server } from "../server";

/** A panel's kind and its arguments, such as `port`; stored in the URL. `title` replaces its own. */
export interface PanelArgs {
  readonly kind: string;
  readonly [key: string]: string | undefined;
}

/** Services of the shell for a panel. */
export interface PanelHost {
  readonly server: Server;
  /** Opens a panel, or goes to the one with these arguments. */
  openPanel(args: PanelArgs): void;
  /** Title of this panel. */
  setTitle(title: string): void;
  /** Changes this panel's arguments, also in the URL, without recreating it. */
  setArgs(args: PanelArgs): void;
  /** Shows a sentence in the status line, also for screen readers. */
  say(sentence: string): void;
  /** Place for buttons, to the right of the panel's title. */
  readonly tools: HTMLElement;
}

/** A panel, made by its kind. */
export interface Panel {
  readonly element: HTMLElement;
  /** Ends the panel's streams and timers. */
  close?(): void;
}

export type PanelKind = (args: PanelArgs, host: PanelHost) => Panel;

/** Makes panels, by kind; filled by src/page.ts. */
export const panelKinds: Record<string, PanelKind> = {};
