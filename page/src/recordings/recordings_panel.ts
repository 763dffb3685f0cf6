// SPDX-License-Identifier: Apache-2.0
// Records streams, lists recordings, opens and deletes them: {kind: "recordings"}.
import { bytesText } from "../graph/words";
import { CommandError, mayOperate, type Recording, type Session } from "../server";
import { button, fill, h, type PanelHost, type PanelKind } from "../shell";
import { giveFiles } from "./local";
import { RecordForm } from "./record_form";

export const recordingsPanel: PanelKind = (_args, host) => {
  host.setTitle("Recordings");
  return new RecordingsPanel(host);
};

class RecordingsPanel {
  readonly element: HTMLElement;
  private readonly list = h("ul.recording-list");
  private readonly problem = h("p.problem", { role: "alert", hidden: true });
  private readonly dialog = h("dialog.confirm.box", { "aria-labelledby": "confirm-words" });
  private readonly ends: (() => void)[];
  private isRecording?: boolean;

  constructor(private readonly host: PanelHost) {
    const { server } = host;
    const form = new RecordForm(
      host,
      (text) => this.command(text),
      (text) => this.showProblem(text),
    );
    const files = h("input", {
      type: "file",
      multiple: true,
      accept: ".mcap,.mtp",
      "aria-label": "Files to open",
      onchange: () => this.openFiles(files.files ?? []),
    });
    this.element = h(
      "div.recordings",
      {
        ondragover: (event) => event.preventDefault(),
        ondrop: (event) => {
          event.preventDefault();
          this.openFiles(event.dataTransfer?.files ?? []);
        },
      },
      [
        this.problem,
        h("h3", "Record"),
        form.element,
        h("h3", "On the server"),
        this.list,
        h("h3", "From this computer"),
        h("p.muted", "Choose .mcap or .mtp files, also those of hc record, or drop them here."),
        files,
        this.dialog,
      ],
    );
    this.ends = [
      server.onState((state) => form.showState(state)),
      server.onSession((session) => {
        form.showSession(session);
        this.showSession(session);
      }),
    ];
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

  private showSession({ recording }: Session): void {
    const isRecording = recording !== null;
    if (!isRecording && this.isRecording !== isRecording) void this.refresh();
    this.isRecording = isRecording;
  }

  private async refresh(): Promise<void> {
    try {
      const recordings = await this.host.server.recordings();
      fill(
        this.list,
        recordings.map((recording) => this.item(recording)),
        recordings.length === 0 && h("li.muted", "No recordings yet."),
      );
    } catch (error) {
      fill(this.list, h("li.muted", error instanceof Error ? error.message : ""));
    }
  }

  private item(recording: Recording): HTMLElement {
    const { name, bytes, streams, problem } = recording;
    const count = `${streams.length} ${streams.length === 1 ? "stream" : "streams"}`;
    const open = () => this.host.openPanel({ kind: "replay", name });
    return h("li", [
      h("strong", name),
      h("span.muted.mono", bytesText(bytes)),
      h("span.muted", { title: streams.join("\n") }, problem ?? count),
      h("span.recording-actions", [
        problem === undefined && button("Open", open, { "aria-label": `Open ${name}` }),
        h(
          "a",
          {
            href: `/recordings/${name}.mcap`,
            download: `${name}.mcap`,
            "aria-label": `Download ${name}`,
          },
          "Download",
        ),
        mayOperate(this.host.server.session) &&
          button("Delete…", () => this.ask(recording), { "aria-label": `Delete ${name}` }),
      ]),
    ]);
  }

  /** Deletes a recording after a confirmation. */
  private ask({ name, bytes }: Recording): void {
    const remove = async () => {
      this.dialog.close();
      if (!(await this.command(`record delete ${name}`))) return;
      this.host.say(`Deleted ${name}.`);
      await this.refresh();
    };
    fill(
      this.dialog,
      h(
        "p",
        { id: "confirm-words" },
        `Delete ${name} (${bytesText(bytes)}) from the server for good?`,
      ),
      h("div.row", [
        button("Keep", () => this.dialog.close(), { autofocus: true }),
        button("Delete", () => void remove(), { class: "danger" }),
      ]),
    );
    this.dialog.showModal();
  }

  private openFiles(files: Iterable<File>): void {
    if (giveFiles(files) === 0)
      return this.showProblem("None of these files is a recording, .mcap or .mtp.");
    this.showProblem("");
    this.host.openPanel({ kind: "replay", files: String(Date.now() % 1_000_000) });
  }
}
