// SPDX-License-Identifier: Apache-2.0
// The poses that outputs of the graph send, as often as a person can read them.
import type { Server, Stream } from "../server";
import { poseOf, type Pose } from "../views/pose";

const rate = 5; // [Hz]

export class Poses {
  private readonly streams = new Map<string, Stream>();

  constructor(
    private readonly server: Server,
    private readonly show: (port: string, pose: Pose) => void,
  ) {}

  /** Follows these outputs and no others. */
  follow(ports: ReadonlySet<string>): void {
    for (const [port, stream] of this.streams) {
      if (ports.has(port)) continue;
      stream.close();
      this.streams.delete(port);
    }
    for (const port of ports) {
      if (this.streams.has(port)) continue;
      const stream = this.server.stream(port, { rate });
      stream.on("message", ({ message }) => {
        const pose = poseOf(message);
        if (pose) this.show(port, pose);
      });
      this.streams.set(port, stream);
    }
  }

  close(): void {
    this.follow(new Set());
  }
}
