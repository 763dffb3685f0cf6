// SPDX-License-Identifier: Apache-2.0
// Strings as a console.
import { rowsOf } from "../mtp";
import type { Arrival } from "../server";
import { h } from "../shell/h";
import type { View, ViewHost, ViewKind } from "./view";

const mostLines = 5000;

export class ConsoleView implements View {
  readonly keepsPast = true;
  private readonly lines = h("div.console.mono", {
    role: "log",
    tabindex: 0,
    "aria-label": "Lines",
  });
  readonly element = this.lines;
  private isPaused = false;
  private lastTime = 0n;

  constructor(private readonly host: ViewHost) {}

  show(arrival: Arrival): void {
    const { time } = arrival.message.header;
    // A recording was rewound: start over.
    if (this.host.source.isReplay && time < this.lastTime) this.lines.replaceChildren();
    this.lastTime = time;
    const at = new Date(time > 0n ? Number(time / 1_000_000n) : arrival.at);
    const clock = at.toLocaleTimeString([], { hour12: false });
    const isAtEnd = this.lines.scrollTop + this.lines.clientHeight >= this.lines.scrollHeight - 20;
    for (const row of rowsOf(arrival.message)) {
      this.lines.append(
        h("div", [h("time.muted", { datetime: at.toISOString() }, clock), " ", row]),
      );
    }
    while (this.lines.childElementCount > mostLines) this.lines.firstElementChild?.remove();
    if (isAtEnd && !this.isPaused) this.lines.scrollTop = this.lines.scrollHeight;
  }

  setPaused(paused: boolean): void {
    this.isPaused = paused;
  }
}

export const consoleView: ViewKind = {
  name: "console",
  fits: (sent) => sent.type === "string",
  make: (host) => new ConsoleView(host),
};
