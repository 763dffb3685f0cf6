// SPDX-License-Identifier: Apache-2.0
// A recording on a timeline: {kind: "replay", name?, streams?}; without a name the opened files.
import { h, type PanelHost, type PanelKind } from "../shell";
import { StreamView, type Source, type Surroundings } from "../views";
import { openRecording } from "./local";
import { Player } from "./player";
import type { Track } from "./track";

const speeds = [0.1, 0.25, 0.5, 1, 2, 4, 8];
const shownAtFirst = 4;

export const replayPanel: PanelKind = (args, host) => {
  const name = args.name ?? "";
  host.setTitle(name === "" ? "Recording: files" : `Recording ${name}`);
  const status = h("p", { class: "muted", role: "status" }, "Reading …");
  const element = h("div", { class: "replay" }, status);
  let replay: Replay | undefined;
  let isClosed = false;
  openRecording(name, (words) => (status.textContent = words))
    .then((tracks) => {
      if (isClosed) return;
      if (tracks.length === 0) {
        status.textContent =
          name === ""
            ? "No files are open. Open .mcap or .mtp files in the panel Recordings."
            : "This recording has no messages.";
        return;
      }
      const chosen = args.streams?.split(" ") ?? usualStreams(tracks);
      replay = new Replay(tracks, chosen, host, (streams) =>
        host.setArgs({ ...args, streams: streams.join(" ") }),
      );
      element.replaceChildren(replay.element);
    })
    .catch((error: unknown) => {
      status.textContent = error instanceof Error ? error.message : String(error);
      status.className = "problem";
    });
  return {
    element,
    close: () => {
      isClosed = true;
      replay?.close();
    },
  };
};

/** The streams with the largest messages, usually images. */
function usualStreams(tracks: readonly Track[]): string[] {
  return [...tracks]
    .sort((a, b) => b.usualBytes - a.usualBytes)
    .slice(0, shownAtFirst)
    .map(({ port }) => port);
}

/** A source for a stream that was not recorded. */
function missing(port: string): Source {
  const nothing = () => () => {};
  return { port, isReplay: true, on: nothing, setWidth: nothing, close: nothing };
}

class Replay {
  readonly element: HTMLElement;
  private readonly player: Player;
  private readonly surroundings: Surroundings;
  private readonly views = new Map<string, { view: StreamView; element: HTMLElement }>();
  private readonly room = h("div", { class: "replay-views" });
  private readonly clock = h("output", { class: "mono clock" });
  private readonly scrub: HTMLInputElement;

  constructor(
    tracks: readonly Track[],
    chosen: readonly string[],
    private readonly host: PanelHost,
    private readonly changed: (streams: string[]) => void,
  ) {
    const player = new Player(tracks);
    this.player = player;
    this.surroundings = {
      state: undefined,
      session: host.server.session,
      ready: () => Promise.resolve(),
      open: (port) => player.open(port) ?? missing(port),
      outputsBeside: (port) =>
        Promise.resolve(tracks.find((track) => track.port === port)?.outputs ?? []),
      outputs: () =>
        Promise.resolve(
          tracks.flatMap(({ port, outputs }) => outputs.filter((output) => output.port === port)),
        ),
    };
    const play = h("button", {
      class: "primary",
      onclick: () => (player.isPlaying ? player.pause() : player.play()),
    });
    player.onPlaying((isPlaying) => (play.textContent = isPlaying ? "Pause" : "Play"));
    const speed = h(
      "select",
      { "aria-label": "Speed", onchange: () => player.setSpeed(Number(speed.value)) },
      speeds.map((each) => h("option", { value: each, selected: each === 1 }, `${each} ×`)),
    );
    this.scrub = h("input", {
      type: "range",
      min: 0,
      max: player.end - player.begin,
      step: 0.01,
      "aria-label": "Time in the recording",
      oninput: () => player.goTo(player.begin + Number(this.scrub.value)),
    });
    player.onTime((time) => this.showTime(time));
    const boxes = tracks.map((track) => this.box(track, chosen));
    this.element = h(
      "div",
      { class: "replay" },
      h("div", { class: "timeline" }, play, speed, this.scrub, this.clock),
      h("details", { class: "replay-choice" }, h("summary", {}, `${tracks.length} streams`), [
        h("div", { class: "replay-streams" }, boxes),
      ]),
      this.room,
    );
    for (const { port } of tracks) if (chosen.includes(port)) this.open(port);
  }

  close(): void {
    for (const port of [...this.views.keys()]) this.shut(port);
    this.player.close();
  }

  private box(track: Track, chosen: readonly string[]): HTMLElement {
    const { port } = track;
    const box = h("input", {
      type: "checkbox",
      onchange: () => {
        if (box.checked) this.open(port);
        else this.shut(port);
        this.changed([...this.views.keys()]);
      },
    });
    box.checked = chosen.includes(port);
    const marks = h("canvas", { class: "marks", width: 200, height: 8, "aria-hidden": "true" });
    this.drawMarks(marks, track);
    return h("label", { title: `${track.length} messages` }, box, port, marks);
  }

  /** Draws when there are messages. */
  private drawMarks(canvas: HTMLCanvasElement, track: Track): void {
    const context = canvas.getContext("2d")!;
    const { begin, end } = this.player;
    context.fillStyle = "#3b82c4";
    const step = Math.max(1, Math.floor(track.length / 1000));
    for (let i = 0; i < track.length; i += step) {
      const part = end > begin ? (track.timeAt(i) - begin) / (end - begin) : 0;
      context.fillRect(part * (canvas.width - 1), 0, 1, canvas.height);
    }
  }

  private open(port: string): void {
    const source = this.player.open(port);
    if (!source) return;
    const tools = h("div", { class: "tools" });
    const view = new StreamView(source, {
      surroundings: this.surroundings,
      tools,
      say: (sentence) => this.host.say(sentence),
    });
    const element = h(
      "section",
      { class: "replay-view", "aria-label": port },
      h("div", { class: "panel-bar" }, h("h3", {}, port), tools),
      view.element,
    );
    this.views.set(port, { view, element });
    this.room.append(element);
  }

  private shut(port: string): void {
    const shown = this.views.get(port);
    shown?.view.close();
    shown?.element.remove();
    this.views.delete(port);
  }

  private showTime(time: number): void {
    const { begin, end } = this.player;
    this.scrub.value = String(time - begin);
    const words = `${(time - begin).toFixed(2)} of ${(end - begin).toFixed(2)} s`;
    this.scrub.setAttribute("aria-valuetext", words);
    this.clock.textContent = words;
    this.clock.title = new Date(time * 1000).toISOString();
  }
}
