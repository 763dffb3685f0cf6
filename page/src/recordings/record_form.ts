// SPDX-License-Identifier: Apache-2.0
// Starts and ends a recording: its name, and its streams by a preset or one by one.
import { bytesText } from "../graph/words";
import { outletsOf, type Outlet } from "../outputs";
import { mayOperate, type GraphLink, type GraphState, type Session } from "../server";
import { fill, h, setText, type PanelHost } from "../shell";
import { help } from "../shell/help";
import { amountOf, presetsOf, type Preset } from "./presets";

/** A name for a new recording: the time, such as 20261122-210705. */
export function nameOfNow(now: Date): string {
  const two = (value: number) => String(value).padStart(2, "0");
  const day = `${now.getFullYear()}${two(now.getMonth() + 1)}${two(now.getDate())}`;
  return `${day}-${two(now.getHours())}${two(now.getMinutes())}${two(now.getSeconds())}`;
}

/** "23 streams, about 2.1 MB/s". */
function amountText(ports: readonly string[], rate: number): string {
  const count = `${ports.length} ${ports.length === 1 ? "stream" : "streams"}`;
  return rate > 0 ? `${count}, about ${bytesText(rate)}/s` : count;
}

const ownChoice = "My choice";

const streamsHelp = () =>
  help(
    "recorded",
    "A stream is what a module sends by one of its outputs. Images are recorded as JPEG, all else " +
      "as it is. The rates are estimates from what the links of the graph carry now.",
  );

export class RecordForm {
  readonly element: HTMLFormElement;
  private readonly name = h("input", {
    "aria-label": "Name of the recording",
    pattern: "[A-Za-z0-9_\\-]{1,40}",
    title: "Letters, digits, - and _, at most 40",
    required: true,
    value: nameOfNow(new Date()),
  });
  private readonly button = h("button.primary", "Start recording");
  private readonly running = h("p.running-words", { role: "status" });
  private readonly choices = h("div.presets");
  private readonly streams = h("div.stream-choice", { hidden: true });
  private readonly fields = h("fieldset", [
    h("legend", ["Streams", streamsHelp()]),
    this.choices,
    this.streams,
  ]);
  private readonly amounts = new Map<string, HTMLElement>(); // by preset
  private outlets: readonly Outlet[] = [];
  private presets: Preset[] = [];
  private chosen = "";
  private readonly own = new Set<string>();
  private links: readonly GraphLink[] = [];
  private modules = "";

  /** @param command  sends a command; whether it was executed. */
  constructor(
    private readonly host: PanelHost,
    private readonly command: (text: string) => Promise<boolean>,
    private readonly problem: (text: string) => void,
  ) {
    this.element = h(
      "form.record-form",
      {
        onsubmit: (event) => {
          event.preventDefault();
          void this.submit();
        },
      },
      [h("div.row", [this.name, this.button]), this.running, this.fields],
    );
  }

  showSession(session: Session): void {
    const { recording } = session;
    this.fields.disabled = recording !== null;
    this.name.disabled = recording !== null;
    this.button.disabled = !mayOperate(session);
    this.button.title = mayOperate(session)
      ? ""
      : "This page may not record. Ask for a URL with the right to operate.";
    setText(this.button, recording ? "End recording" : "Start recording");
    if (!recording) return setText(this.running, "");
    const { name, seconds, bytes, streams } = recording;
    const parts = [`${seconds.toFixed(0)} s`, bytesText(bytes)];
    if (seconds > 0) parts.push(`${bytesText(bytes / seconds)}/s`);
    setText(this.running, `● ${name}: ${parts.join(", ")}, ${streams.length} streams`);
  }

  showState(state: GraphState): void {
    this.links = state.links;
    this.showAmounts();
    const modules = state.modules.map(({ name }) => name).join();
    if (modules === this.modules) return;
    this.modules = modules;
    void outletsOf(this.host.server).then((outlets) => this.setOutlets(outlets));
  }

  private async submit(): Promise<void> {
    if (this.host.server.session?.recording) {
      await this.command("record end");
      return;
    }
    const ports = this.portsOf(this.chosen);
    if (ports.length === 0) return this.problem("Choose at least one stream.");
    const name = this.name.value;
    if (!(await this.command(["record", name, ...ports].join(" ")))) return;
    this.host.say(`Recording ${name}.`);
    this.name.value = nameOfNow(new Date(Date.now() + 1000));
  }

  private setOutlets(outlets: readonly Outlet[]): void {
    this.outlets = outlets;
    this.presets = presetsOf(outlets);
    const names = [...this.presets.map(({ name }) => name), ownChoice];
    if (!names.includes(this.chosen)) this.chosen = names[0]!;
    fill(
      this.choices,
      this.presets.map(({ name, detail }) => this.choice(name, detail)),
      this.choice(ownChoice, "stream by stream"),
    );
    this.showStreams();
    this.showAmounts();
  }

  private portsOf(preset: string): readonly string[] {
    return this.presets.find(({ name }) => name === preset)?.ports ?? [...this.own];
  }

  private choice(name: string, detail: string): HTMLElement {
    const radio = h("input", { type: "radio", name: "preset", checked: name === this.chosen });
    radio.onchange = () => {
      // One's own choice begins with the preset before.
      if (name === ownChoice && this.own.size === 0)
        for (const port of this.portsOf(this.chosen)) this.own.add(port);
      this.chosen = name;
      this.showStreams();
      this.showAmounts();
    };
    const amount = h("span.preset-amount.muted.small");
    this.amounts.set(name, amount);
    return h("label.preset", [
      radio,
      h("span", [h("strong", name), " ", h("span.muted", detail)]),
      amount,
    ]);
  }

  private showAmounts(): void {
    const outputs = this.outlets.flatMap((each) => each.outputs);
    for (const [name, element] of this.amounts) {
      const ports = this.portsOf(name);
      const { rate, unknown } = amountOf(ports, outputs, this.links);
      setText(element, ports.length === 0 ? "" : amountText(ports, rate));
      element.title = unknown > 0 ? `Without ${unknown} that no link carries now.` : "";
    }
  }

  /** One's own choice, by module. */
  private showStreams(): void {
    this.streams.hidden = this.chosen !== ownChoice;
    if (this.streams.hidden) return;
    const groups = this.outlets.filter(({ outputs }) => outputs.length > 0);
    fill(
      this.streams,
      groups.map(({ name, summary, outputs }) =>
        h("fieldset.stream-group", [
          h("legend", { title: summary }, name),
          outputs.map(({ port, type, doc }) => {
            const box = h("input", {
              type: "checkbox",
              value: port,
              "aria-label": port,
              checked: this.own.has(port),
            });
            box.onchange = () => {
              if (box.checked) this.own.add(port);
              else this.own.delete(port);
              this.showAmounts();
            };
            const title = [type, doc].filter(Boolean).join(": ");
            return h("label", { title }, [box, port.slice(name.length + 1)]);
          }),
        ]),
      ),
    );
  }
}
