// SPDX-License-Identifier: Apache-2.0

/** Events of a socket. */
export interface SocketEvents {
  open?(): void;
  text?(text: string): void;
  binary?(bytes: Uint8Array<ArrayBuffer>): void;
  /** The socket is closed. `retry`: seconds until the next try; null: none. */
  lost?(code: number, reason: string, retry: number | null): void;
}

/** Close codes after which a retry is useless (spec/page.md). */
const final = new Set([1000, 1007, 1008, 1009, 4404, 4409]);

/**
 * A WebSocket to a path of this server that reconnects, after 0.25 s, doubled up to 5 s.
 */
export class Socket {
  private socket?: WebSocket;
  private delay = 0.25; // [s]
  private timer?: number;
  private closed = false;

  /** @param path  called for each connection. */
  constructor(
    private readonly path: () => string,
    private readonly events: SocketEvents,
  ) {
    this.connect();
  }

  /** Sends if the socket is open; returns whether it was. */
  send(data: string | Uint8Array<ArrayBuffer>): boolean {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(data);
    return true;
  }

  /** Retries at once instead of waiting. */
  retry(): void {
    if (this.closed || !this.socket || this.socket.readyState < WebSocket.CLOSING) return;
    clearTimeout(this.timer);
    this.connect();
  }

  /** Connects again. */
  reopen(): void {
    if (this.closed) return;
    clearTimeout(this.timer);
    const former = this.socket;
    this.connect();
    former?.close();
  }

  close(): void {
    this.closed = true;
    clearTimeout(this.timer);
    this.socket?.close();
  }

  private connect(): void {
    const url = new URL(this.path(), location.href);
    url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
    url.hash = "";
    const socket = new WebSocket(url);
    this.socket = socket;
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      if (this.socket !== socket) return;
      this.delay = 0.25;
      this.events.open?.();
    };
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => {
      if (this.closed || this.socket !== socket) return;
      if (typeof event.data === "string") this.events.text?.(event.data);
      else this.events.binary?.(new Uint8Array(event.data));
    };
    socket.onclose = (event) => {
      if (this.closed || this.socket !== socket) return;
      const retry = final.has(event.code) ? null : this.delay;
      if (retry !== null) {
        this.timer = window.setTimeout(() => this.connect(), retry * 1000);
        this.delay = Math.min(5, this.delay * 2);
      }
      this.events.lost?.(event.code, event.reason, retry);
    };
  }
}
