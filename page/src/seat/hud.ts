// SPDX-License-Identifier: Apache-2.0
// The direction of gaze and the motion-to-photon latency, written over the image.
import type { Server, Session, Stream } from "../server";
import { h, setText } from "../shell";
import { headOutput } from "./gaze";
import type { Latency } from "./latency";
import { angleText, poseOf } from "../views/pose";

const rate = 5; // [Hz]

export class Hud {
  private readonly gaze = h("span");
  private readonly delay = h("span.seat-latency", {
    title: "Motion to photon: from a command to the first image that shows it",
  });
  readonly element = h("p.seat-hud", [this.gaze, this.delay]);
  private stream?: Stream;

  constructor(
    private readonly server: Server,
    private readonly latency: Latency,
  ) {}

  update(session: Session): void {
    const port = headOutput(session.frames);
    if (this.stream?.port === port) return;
    this.stream?.close();
    this.stream = port === undefined ? undefined : this.server.stream(port, { rate });
    this.stream?.on("message", ({ message }) => {
      const pose = poseOf(message);
      if (!pose) return;
      const pan = angleText(pose.pan, "left", "right", 0);
      setText(this.gaze, `Head ${pan}, ${angleText(pose.tilt, "down", "up", 0)}`);
    });
  }

  showLatency(): void {
    const { median, p99, measurements } = this.latency;
    if (median === undefined || p99 === undefined) return;
    setText(this.delay, `${Math.round(median)} ms`);
    const detail = `p99 ${Math.round(p99)} ms, of ${measurements.length}`;
    this.delay.title = `Motion to photon: from a command to the first image that shows it; ${detail}`;
  }

  close(): void {
    this.stream?.close();
  }
}
