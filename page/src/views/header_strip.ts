// SPDX-License-Identifier: Apache-2.0
import { coordName, headerFields, type Header, type HeaderField } from "../mtp";
import type { Arrival } from "../server";
import { fill, h } from "../shell/h";

const meanings: Record<HeaderField, string> = {
  version: "version of the protocol",
  src: "address of the output that made the message",
  dst: "0: follows the link; > 0: one port; < 0: all or a group",
  seq: "increases by one; a gap is a loss",
  ttl: "routers left to pass",
  time: "time of the sensed event [ns since 1970]",
  info: "type, components, scalar and encoding of the elements",
  mode: "system mode of the sender",
  coord: "coordinate system of the elements",
  width: "elements in a row",
  height: "rows",
};

const period = 2; // window of measured rates [s]

/** The header as on the wire, with field names; rate, latency, loss. */
export class HeaderStrip {
  private readonly fields = headerFields.map((name) => {
    const value = h("span.value");
    const element = h("span.field", { title: `${name}: ${meanings[name]}` });
    element.append(h("span.name", name), " ", value);
    return { name, element, value };
  });
  private readonly summary = h("span.summary.wrap");
  readonly element = h(
    "div.header-strip.muted",
    { tabindex: 0, role: "group", "aria-label": "Header and figures" },
    [
      this.summary,
      h(
        "div.fields.wrap.mono",
        this.fields.map(({ element }) => element),
      ),
    ],
  );
  private readonly times: number[] = []; // of arrivals, by performance.now() [ms]
  private latency?: number; // [s]
  private lastSeq?: bigint;
  private lost = 0n;
  private sent?: Header;
  private drawn = 0;

  /** Takes the original header line. */
  setLine(line: string): void {
    const words = line.trim().split(/ +/);
    this.fields.forEach(({ value }, i) => (value.textContent = words[i] ?? ""));
  }

  /** Counts a message. */
  count(arrival: Arrival, sent: Header, isReplay = false): void {
    const { seq, time } = arrival.message.header;
    this.sent = sent;
    const now = performance.now(); // the wall clock may be set
    this.times.push(now);
    while (this.times[0]! < now - period * 1000) this.times.shift();
    if (!isReplay && this.lastSeq !== undefined && seq > this.lastSeq + 1n)
      this.lost += seq - this.lastSeq - 1n;
    this.lastSeq = seq;
    if (time > 0n && !isReplay) this.latency = arrival.at / 1000 - Number(time) / 1e9;
    if (now - this.drawn > 250) this.draw();
  }

  /** Shows the figures; also called periodically, so that the rate falls without messages. */
  draw(): void {
    this.drawn = performance.now();
    const { sent, times } = this;
    if (!sent) return;
    const recent = times.filter((time) => time > this.drawn - period * 1000);
    const size = `${sent.width} × ${sent.height} of ${sent.components} × ${sent.scalar}`;
    const parts = [
      `${sent.type} ${size}, ${coordName(sent.coord)}`,
      `${(recent.length / period).toFixed(1)}/s`,
      this.latency !== undefined && Math.abs(this.latency) < 3600
        ? `${(this.latency * 1000).toFixed(0)} ms old`
        : "",
      this.lost > 0n ? `${this.lost} not shown` : "",
    ];
    fill(this.summary, ...parts.filter(Boolean).map((part) => h("span", part)));
    this.summary.title =
      "Type and size; messages a second here; time from sensing to arrival; gaps of seq: messages that " +
      "this page skipped for newer ones";
  }
}
