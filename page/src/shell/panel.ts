// SPDX-License-Identifier: Apache-2.0
import type { Server } from "../server";

/** What a panel shows: its kind, and what that kind needs, such as `port`. It is kept in the URL. */
export interface PanelArgs {
  readonly kind: string;
  readonly [key: string]: string | undefined;
}

/** What the shell gives a panel. */
export interface PanelHost {
  readonly server: Server;
  /** Opens a panel, or goes to the one that shows just this. */
  openPanel(args: PanelArgs): void;
  /** Title of this panel. */
  setTitle(title: string): void;
  /** Changes what this panel shows, in the URL too; it is not made again. */
  setArgs(args: PanelArgs): void;
  /** Says a sentence to the person, in the status line and to screen readers. */
  say(sentence: string): void;
  /** Room for buttons at the right of the panel's title. */
  readonly tools: HTMLElement;
}

/** A panel as its kind makes it. */
export interface Panel {
  readonly element: HTMLElement;
  /** Ends what the panel has begun: streams, timers. */
  close?(): void;
}

export type PanelKind = (args: PanelArgs, host: PanelHost) => Panel;

/** Who makes panels of a kind. src/page.ts fills it. */
export const panelKinds: Record<string, PanelKind> = {};
