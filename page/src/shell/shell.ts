// SPDX-License-Identifier: Apache-2.0
import type { Connection, GraphState, Server, Session } from "../server";
import { Board } from "./board";
import { button, emOf, fill, h } from "./h";
import { helpDialog } from "./help";
import { layoutOf, layoutText, type Layout } from "./layout";
import { opener } from "./opener";
import { panelKinds, type PanelArgs } from "./panel";
import { themeButton } from "./theme";
import { layoutFor, viewOf, views, type View } from "./view";

/** How long a sentence is shown [ms]. */
const sentenceLife = 10_000;
const viewNames: Record<View, [string, string]> = {
  drive: ["Drive", "Steer the head, choose its task"],
  watch: ["Watch", "What the robot does, and why"],
  build: ["Build", "Streams, modules, parameters, log, recordings"],
};

/** The page: a bar, and one of three views of panels. */
export class Shell {
  readonly element: HTMLElement;
  /** Place in the bar for words on what the robot does; one of its elements is visible. */
  readonly words = h("div.words");
  /** Place in the bar for the stop. */
  readonly stopSlot = h("div.stop-slot");
  /** The area below the bar. */
  readonly stage: HTMLElement;
  private readonly graphName = h("h1", "Hypercolumn");
  private readonly links = views.map((view) =>
    h("a", { href: `#${view}`, title: viewNames[view][1] }, viewNames[view][0]),
  );
  private readonly openButton: HTMLButtonElement;
  private readonly recording = h("button.recording-now", {
    hidden: true,
    onclick: () => this.openPanel({ kind: "recordings" }),
  });
  private readonly trouble = h("div.trouble.row", { role: "alert", hidden: true });
  private readonly said = h("div.status-line", { role: "status", "aria-live": "polite" });
  private silence = 0; // the timer that clears it
  private readonly board: Board;
  private view?: View;
  /** The panels of Build. */
  private built?: Layout;

  constructor(readonly server: Server) {
    this.board = new Board({
      server,
      say: (sentence) => this.say(sentence),
      changed: () => this.store(),
      openPanel: (args) => this.openPanel(args),
    });
    const panels = opener(server, (args) => this.openPanel(args));
    const help = helpDialog();
    this.openButton = button("Open…", () => panels.showModal(), { title: "Open a panel" });
    this.words.append(this.trouble);
    this.stage = h("div.stage", [this.board.element, this.said]);
    this.element = h("div.shell.stack", [
      h("header.bar", [
        button("Go to the panels", () => this.board.element.focus(), { class: "skip" }),
        this.graphName,
        h("nav.switch", { "aria-label": "View" }, this.links),
        this.words,
        h("div.bar-tools.row", [
          this.recording,
          this.openButton,
          button("?", () => help.showModal(), {
            class: "icon",
            title: "Help (?)",
            "aria-label": "Help",
          }),
          themeButton(),
        ]),
        this.stopSlot,
      ]),
      this.stage,
      panels,
      help,
    ]);
    server.onConnection((connection) => this.showConnection(connection));
    server.onState((state) => this.showState(state));
    server.onSession((session) => this.showSession(session));
    addEventListener("hashchange", () => this.follow());
    addEventListener("keydown", ({ key, target }) => {
      const isText = target instanceof HTMLElement && target.matches("input, textarea, select");
      const isClosed = this.element.querySelector("dialog[open]") === null;
      if (key === "?" && !isText && isClosed) help.showModal();
    });
    this.follow();
  }

  /** Opens a panel in Build. */
  openPanel(args: PanelArgs): void {
    if (!panelKinds[args.kind]) return this.say(`Unknown panel ${args.kind}.`);
    if (this.view !== "build") {
      history.pushState(null, "", "#build");
      this.follow();
    }
    this.board.open(args);
  }

  /** Shows a sentence for a while. */
  say(sentence: string): void {
    this.said.textContent = sentence;
    window.clearTimeout(this.silence);
    this.silence = window.setTimeout(() => (this.said.textContent = ""), sentenceLife);
  }

  /** Shows the view in the URL, or its panels in Build. */
  private follow(): void {
    const { state } = this.server;
    const view = viewOf(location.hash);
    const hasPanels = view === "build" && location.hash !== "#build";
    this.view = view;
    this.element.dataset.view = view;
    this.links.forEach((link, i) =>
      link.setAttribute("aria-current", views[i] === view ? "page" : "false"),
    );
    this.openButton.hidden = view !== "build";
    if (hasPanels) this.built = layoutOf(location.hash);
    else if (!state) return void this.server.ready().then(() => this.follow());
    const usual = () => layoutFor(view, state!, innerWidth / emOf(this.element));
    this.board.show(view === "build" ? (this.built ??= usual()) : usual());
    this.store();
  }

  /** Keeps the panels of Build in the URL. */
  private store(): void {
    if (this.view !== "build") return;
    this.built = this.board.current;
    history.replaceState(null, "", "#" + (layoutText(this.built) || "build"));
  }

  private showConnection(connection: Connection): void {
    this.showCondition();
    this.trouble.hidden = connection.status !== "lost";
    if (connection.status !== "lost") return;
    const { why, retry, ended } = connection;
    if (this.trouble.title === why) return; // so that it is read aloud once
    this.trouble.title = why;
    fill(
      this.trouble,
      h("p", [h("strong", ended ? "ENDED" : "NO CONNECTION"), " ", h("span", why)]),
      retry !== null && button("Try now", () => this.server.reconnect()),
    );
  }

  /** Colours the page by the condition of the robot and its server. */
  private showCondition(): void {
    const { connection, session } = this.server;
    const isStopped = connection.status === "open" && session?.stopped === true;
    const hasEnded = connection.status === "lost" && connection.ended;
    this.element.dataset.condition = isStopped ? "stopped" : hasEnded ? "ended" : connection.status;
  }

  private showState(state: GraphState): void {
    if (this.graphName.textContent === state.graph) return;
    this.graphName.textContent = state.graph;
    this.graphName.title = state.file;
    document.title = `${state.graph} – Hypercolumn`;
  }

  private showSession(session: Session): void {
    this.showCondition();
    const { recording } = session;
    this.recording.hidden = recording === null;
    if (!recording) return;
    const seconds = Math.floor(recording.seconds);
    const time = `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, "0")}`;
    this.recording.textContent = `● ${time}`;
    this.recording.title = `Recording ${recording.name}; show recordings`;
    this.recording.setAttribute("aria-label", this.recording.title);
  }
}
