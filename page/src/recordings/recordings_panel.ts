// SPDX-License-Identifier: Apache-2.0
// Records streams, lists recordings, opens them: {kind: "recordings"}.
import { CommandError, mayOperate, type GraphState, type Recording, type Session } from "../server";
import { outputsOf, type Output } from "../outputs";
import { fill, h, type PanelHost, type PanelKind } from "../shell";
import { giveFiles } from "./local";

export function bytesText(bytes: number): string {
  const units = ["B", "kB", "MB", "GB", "TB"];
  let unit = 0;
  while (bytes >= 1000 && unit < units.length - 1) {
    bytes /= 1000;
    unit += 1;
  }
  return `${unit === 0 ? bytes : bytes.toFixed(bytes < 10 ? 1 : 0)} ${units[unit]}`;
}

/** A name for a new recording: the time, such as 20261122-210705. */
export function nameOfNow(now: Date): string {
  const two = (value: number) => String(value).padStart(2, "0");
  const day = `${now.getFullYear()}${two(now.getMonth() + 1)}${two(now.getDate())}`;
  return `${day}-${two(now.getHours())}${two(now.getMinutes())}${two(now.getSeconds())}`;
}

export const recordingsPanel: PanelKind = (_args, host) => {
  host.setTitle("Recordings");
  const panel = new RecordingsPanel(host);
  return { element: panel.element, close: () => panel.close() };
};

class RecordingsPanel {
  readonly element: HTMLElement;
  private readonly list = h("ul", { class: "recording-list" });
  private readonly problem = h("p", { class: "problem", role: "alert", hidden: true });
  private readonly begin: HTMLFormElement;
  private readonly running = h("div", { class: "running", hidden: true });
  private readonly streams = h("div", { class: "stream-choice" });
  private readonly name = h("input", {
    "aria-label": "Name of the recording",
    pattern: "[A-Za-z0-9_\\-]{1,40}",
    title: "Letters, digits, - and _, at most 40",
    required: true,
  });
  private readonly start = h("button", { class: "primary" }, "Start recording");
  private readonly ends: (() => void)[];
  private readonly chosen = new Set<string>();
  private modules = "";
  private wasRecording?: string;

  constructor(private readonly host: PanelHost) {
    const { server } = host;
    this.name.value = nameOfNow(new Date());
    this.begin = h(
      "form",
      {
        class: "record-form",
        onsubmit: (event) => {
          event.preventDefault();
          void this.record();
        },
      },
      h("div", { class: "row" }, this.name, this.start),
      h(
        "fieldset",
        {},
        h("legend", {}, "Streams"),
        h(
          "div",
          { class: "row" },
          h("button", { type: "button", onclick: () => this.chooseAll(true) }, "All"),
          h("button", { type: "button", onclick: () => this.chooseAll(false) }, "None"),
        ),
        this.streams,
      ),
    );
    const files = h("input", {
      type: "file",
      multiple: true,
      accept: ".mcap,.mtp",
      "aria-label": "Files to open",
      onchange: () => this.openFiles(files.files ?? []),
    });
    this.element = h(
      "div",
      {
        class: "recordings",
        ondragover: (event) => event.preventDefault(),
        ondrop: (event) => {
          event.preventDefault();
          this.openFiles(event.dataTransfer?.files ?? []);
        },
      },
      this.problem,
      h("h3", {}, "Record"),
      this.running,
      this.begin,
      h("h3", {}, "On the server"),
      this.list,
      h("h3", {}, "Files"),
      h("p", { class: "muted" }, "Choose .mcap or .mtp files, or drop them here."),
      files,
    );
    this.ends = [
      server.onState((state) => this.updateStreams(state)),
      server.onSession((session) => this.showSession(session)),
    ];
    void this.refresh();
  }

  close(): void {
    for (const end of this.ends) end();
  }

  private showProblem(text: string): void {
    this.problem.hidden = text === "";
    this.problem.textContent = text;
  }

  private async command(text: string): Promise<boolean> {
    this.showProblem("");
    try {
      await this.host.server.command(text);
      return true;
    } catch (error) {
      if (!(error instanceof CommandError)) throw error;
      this.showProblem(error.rows.join(" "));
      return false;
    }
  }

  private async record(): Promise<void> {
    if (this.chosen.size === 0) return this.showProblem("Choose at least one stream.");
    const name = this.name.value;
    if (!(await this.command(["record", name, ...this.chosen].join(" ")))) return;
    this.host.say(`Recording ${name}.`);
    this.name.value = nameOfNow(new Date(Date.now() + 1000));
  }

  /** Updates the outputs when modules have been added or removed. */
  private updateStreams(state: GraphState): void {
    const modules = state.modules.map(({ name }) => name).join();
    if (modules === this.modules) return;
    this.modules = modules;
    void outputsOf(this.host.server).then((outputs) => this.showStreams(outputs));
  }

  private showStreams(outputs: readonly Output[]): void {
    fill(
      this.streams,
      outputs.map(({ port, type, doc }) => {
        const box = h("input", {
          type: "checkbox",
          value: port,
          onchange: () => (box.checked ? this.chosen.add(port) : this.chosen.delete(port)),
        });
        box.checked = this.chosen.has(port);
        return h("label", { title: [type, doc].filter(Boolean).join(": ") }, box, port);
      }),
    );
  }

  private chooseAll(all: boolean): void {
    for (const box of this.streams.querySelectorAll("input")) {
      box.checked = all;
      if (all) this.chosen.add(box.value);
      else this.chosen.delete(box.value);
    }
  }

  private showSession(session: Session): void {
    const { recording } = session;
    const may = mayOperate(session);
    this.begin.hidden = recording !== null;
    this.running.hidden = recording === null;
    this.start.disabled = !may;
    this.start.title = may
      ? ""
      : "This page may not record. Ask for a URL with the right to operate.";
    if (this.wasRecording !== undefined && recording === null) void this.refresh();
    if (recording && this.wasRecording !== recording.name) {
      fill(
        this.running,
        h("span", { class: "running-words" }),
        may &&
          h(
            "button",
            { class: "primary", onclick: () => void this.command("record end") },
            "End recording",
          ),
      );
    }
    this.wasRecording = recording?.name;
    if (!recording) return;
    this.running.querySelector(".running-words")!.textContent =
      `● ${recording.name}: ${recording.seconds.toFixed(0)} s, ${bytesText(recording.bytes)}, ` +
      `${recording.streams.length} streams`;
  }

  private async refresh(): Promise<void> {
    try {
      const recordings = await this.host.server.recordings();
      fill(
        this.list,
        recordings.map((recording) => this.item(recording)),
      );
      if (recordings.length === 0)
        fill(this.list, h("li", { class: "muted" }, "No recordings yet."));
    } catch (error) {
      fill(this.list, h("li", { class: "muted" }, error instanceof Error ? error.message : ""));
    }
  }

  private item({ name, bytes, streams, problem }: Recording): HTMLElement {
    return h(
      "li",
      {},
      h("strong", {}, name),
      h(
        "span",
        { class: "muted", title: streams.join("\n") },
        `${bytesText(bytes)}, ${problem ?? `${streams.length} streams`}`,
      ),
      problem === undefined &&
        h(
          "button",
          {
            "aria-label": `Open ${name}`,
            onclick: () => this.host.openPanel({ kind: "replay", name }),
          },
          "Open",
        ),
      h("a", { href: `/recordings/${name}.mcap`, download: `${name}.mcap` }, "Download"),
    );
  }

  private openFiles(files: Iterable<File>): void {
    if (giveFiles(files) === 0)
      return this.showProblem("None of these files is a recording, .mcap or .mtp.");
    this.showProblem("");
    this.host.openPanel({ kind: "replay", files: String(Date.now() % 1_000_000) });
  }
}
