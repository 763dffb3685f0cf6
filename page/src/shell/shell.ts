// SPDX-License-Identifier: Apache-2.0
import {
  modesInFocus,
  type Connection,
  type GraphState,
  type Server,
  type Session,
} from "../server";
import { Board } from "./board";
import { defaultLayout } from "./default_layout";
import { button, fill, h } from "./h";
import { layoutOf, layoutText } from "./layout";
import { opener } from "./opener";
import { panelKinds, type PanelArgs } from "./panel";
import { themeButton } from "./theme";

/** How long a sentence stays in the status line [ms]. */
const sentenceLife = 10_000;

/** The page: header, panels, status line. */
export class Shell {
  readonly element: HTMLElement;
  /** Place in the header for the stop button, always visible. */
  readonly headerSlot = h("div.header-slot.row");
  private readonly graphName = h("h1", "Hypercolumn");
  private readonly connection = h("span.connection", { role: "status" });
  private readonly focus = h("span.focus");
  private readonly recording = h("button.recording-now", {
    hidden: true,
    onclick: () => this.openPanel({ kind: "recordings" }),
  });
  private readonly trouble = h("div.trouble.row.wrap", { role: "alert", hidden: true });
  private readonly status = h("div.status-line.muted", { role: "status", "aria-live": "polite" });
  private silence = 0; // the timer that clears it
  private readonly board: Board;

  constructor(readonly server: Server) {
    this.board = new Board({
      server,
      say: (sentence) => this.say(sentence),
      changed: () => this.store(),
    });
    const dialog = opener(server, (args) => this.openPanel(args));
    this.element = h("div.shell.stack", [
      button("Go to the panels", () => this.board.element.focus(), { class: "skip" }),
      h("header.bar.row.wrap", [
        this.graphName,
        this.connection,
        this.focus,
        this.recording,
        h("div.spring"),
        button("Open…", () => dialog.showModal()),
        themeButton(),
        this.headerSlot,
      ]),
      this.trouble,
      this.board.element,
      this.status,
      dialog,
    ]);
    server.onConnection((connection) => this.showConnection(connection));
    server.onState((state) => this.showState(state));
    server.onSession((session) => this.showSession(session));
    addEventListener("hashchange", () => this.board.show(layoutOf(location.hash)));
    if (location.hash.length > 1) this.board.show(layoutOf(location.hash));
    else this.waitForDefault();
  }

  openPanel(args: PanelArgs): void {
    if (panelKinds[args.kind]) this.board.open(args);
    else this.say(`Unknown panel ${args.kind}.`);
  }

  /** Shows a sentence in the status line for a while. */
  say(sentence: string): void {
    this.status.textContent = sentence;
    window.clearTimeout(this.silence);
    this.silence = window.setTimeout(() => (this.status.textContent = ""), sentenceLife);
  }

  private store(): void {
    history.replaceState(null, "", "#" + layoutText(this.board.current));
  }

  private waitForDefault(): void {
    const attempt = () => {
      const { state, session } = this.server;
      if (!state || !session) return;
      for (const end of ends) end();
      if (location.hash.length > 1) return;
      this.board.show(defaultLayout(state, session, innerWidth));
      this.store();
    };
    const ends: (() => void)[] = [];
    ends.push(this.server.onState(attempt), this.server.onSession(attempt));
  }

  private showConnection(connection: Connection): void {
    this.connection.dataset.status = connection.status;
    this.connection.textContent = { connecting: "connecting", open: "live", lost: "no connection" }[
      connection.status
    ];
    this.element.classList.toggle("is-lost", connection.status === "lost");
    if (connection.status === "open") this.trouble.hidden = true;
    if (connection.status !== "lost") return;
    if (!this.trouble.hidden && this.trouble.textContent?.startsWith(connection.why)) return;
    this.trouble.hidden = false;
    fill(
      this.trouble,
      h("span", connection.why),
      connection.retry !== null && button("Try now", () => this.server.reconnect()),
    );
  }

  private showState(state: GraphState): void {
    if (this.graphName.textContent !== state.graph) {
      this.graphName.textContent = state.graph;
      this.graphName.title = state.file;
      document.title = `${state.graph} – Hypercolumn`;
    }
    const modes = modesInFocus(state).map((focus) => focus.mode);
    const task = modes.length > 0 ? modes.join(", ") : "no task";
    const text = Object.keys(state.focus).length > 0 ? task : "";
    if (this.focus.textContent !== text) {
      this.focus.textContent = text;
      this.focus.setAttribute("aria-label", text && `Task in focus: ${text}`);
    }
    this.focus.classList.toggle("has-task", modes.length > 0);
  }

  private showSession(session: Session): void {
    const { recording } = session;
    this.recording.hidden = recording === null;
    if (!recording) return;
    const seconds = Math.floor(recording.seconds);
    const time = `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, "0")}`;
    this.recording.textContent = `● ${recording.name} ${time}`;
    this.recording.setAttribute("aria-label", `Recording ${recording.name}; show recordings`);
  }
}
