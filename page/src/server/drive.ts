// SPDX-License-Identifier: Apache-2.0
import { headerOf, writeMessage, type Message } from "../mtp";
import { Signal } from "./signal";
import { Socket } from "./socket";
import type { DriveOutput } from "./types";

/** The `src` of a driver's messages (W12). */
export const driveSource: Record<DriveOutput, number> = {
  stick: 1,
  rotation: 2,
  target: 3,
  text: 4,
  bid: 5,
  name: 6,
  hold: 7,
};

export type DriveStatus =
  | { readonly status: "connecting" }
  | { readonly status: "driving" }
  | { readonly status: "closed"; readonly why: string };

const beat = writeMessage({
  header: headerOf({ type: "table", components: 1, scalar: "u8", encoding: "text" }, 0, 0),
  elements: new Uint8Array(0),
});

/**
 * The driver's seat. While open, it sends a sign of life each 50 ms, so that the last commands stay
 * valid (W13); this ends with the page, or with close().
 */
export class Drive {
  private readonly statuses = new Signal<DriveStatus>({ status: "connecting" });
  private readonly refusals = new Signal<string>();
  readonly onStatus = this.statuses.on;
  /** Why a command was refused. */
  readonly onRefusal = this.refusals.on;
  private readonly socket: Socket;
  private readonly timer: number;
  private seq = 0n;

  /** @param take  take the seat from another page. */
  constructor(take: boolean) {
    this.socket = new Socket(() => (take ? "/drive?take=1" : "/drive"), {
      open: () => this.statuses.set({ status: "driving" }),
      text: (text) => this.refusals.emit(text),
      lost: (code, reason, retry) => {
        if (retry !== null) return this.statuses.set({ status: "connecting" });
        const isTaken = code === 4409;
        const closed = `Closed by the server: ${reason || String(code)}.`;
        this.statuses.set({ status: "closed", why: isTaken ? "Somebody else drives." : closed });
        this.close();
      },
    });
    this.timer = window.setInterval(() => this.socket.send(beat), 50);
  }

  /** Sends to an output of `web`, with the next seq; returns whether the socket was open. */
  send(output: DriveOutput, message: Message): boolean {
    const header = { ...message.header, src: driveSource[output], seq: this.seq++ };
    return this.socket.send(writeMessage({ ...message, header }));
  }

  close(): void {
    clearInterval(this.timer);
    this.socket.close();
  }
}
