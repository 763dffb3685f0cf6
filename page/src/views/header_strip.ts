// SPDX-License-Identifier: Apache-2.0
import { durationText, rateText } from "../graph/words";
import { coordName, headerFields, type Header, type HeaderField } from "../mtp";
import type { Arrival } from "../server";
import { button, h, setText } from "../shell/h";

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

/** The rate and the age of the messages; on demand, the header as on the wire. */
export class HeaderStrip {
  private readonly values = headerFields.map(() => h("dd.value.mono"));
  private readonly rate = h("span.figure", { title: "Messages shown here, a second" });
  private readonly age = h("span.figure", { title: "From sensing to arrival in this page" });
  private readonly doc = h("p");
  private readonly about = h("p");
  private readonly details = h("div.details", { hidden: true, tabindex: 0 }, [
    this.doc,
    this.about,
    h(
      "dl.fields.wrap",
      headerFields.map((name, i) =>
        h("div", { title: meanings[name] }, [h("dt", name), this.values[i]]),
      ),
    ),
  ]);
  private readonly more = button("Header", () => this.toggle(), {
    "aria-expanded": "false",
    title: "The type of the messages, and the header as on the wire",
  });
  readonly element = h("div.header-strip.muted", [
    h("div.summary.row", [this.rate, this.age, this.more]),
    this.details,
  ]);
  private readonly times: number[] = []; // of arrivals, by performance.now() [ms]
  private latency?: number; // [s]
  private lastSeq?: bigint;
  private lost = 0n;
  private sent?: Header;

  /** Takes the description of the output. */
  setDoc(text: string): void {
    setText(this.doc, text);
  }

  /** Takes the original header line. */
  setLine(line: string): void {
    const words = line.trim().split(/ +/);
    this.values.forEach((value, i) => setText(value, words[i] ?? ""));
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
  }

  /** Shows the figures; called once a second. */
  draw(): void {
    const { sent, times, latency } = this;
    if (!sent) return;
    const recent = times.filter((time) => time > performance.now() - period * 1000);
    setText(this.rate, rateText(recent.length / period) || "0/s");
    const isKnown = latency !== undefined && latency >= 0 && latency < 3600;
    setText(this.age, isKnown ? `${durationText(latency)} old` : "");
    if (this.details.hidden) return;
    const size = `${sent.width} × ${sent.height} of ${sent.components} × ${sent.scalar}`;
    const skipped = this.lost > 0n ? `; ${this.lost} skipped for newer ones` : "";
    setText(this.about, `${sent.type} ${size}, ${coordName(sent.coord)}${skipped}`);
  }

  private toggle(): void {
    const isOpen = this.details.hidden;
    this.details.hidden = !isOpen;
    this.more.setAttribute("aria-expanded", String(isOpen));
    this.draw();
  }
}
