// SPDX-License-Identifier: Apache-2.0
// The direction of gaze and the motion-to-photon latency, written over the image.
import { numbersOf } from "../mtp";
import type { Server, Session, Stream } from "../server";
import { h, setText } from "../shell";
import { headOutput } from "./gaze";
import type { Latency } from "./latency";
import { anglesOfPose, type Angles } from "./orientation";

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
      if (message.header.type !== "transformation") return;
      setText(this.gaze, gazeText(anglesOfPose(numbersOf(message))));
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

/** A direction of gaze: "Head 12° left, 3° down". */
export function gazeText({ yaw, pitch }: Pick<Angles, "yaw" | "pitch">): string {
  const part = (angle: number, positive: string, negative: string): string => {
    const degrees = Math.round((angle * 180) / Math.PI);
    return `${Math.abs(degrees)}° ${degrees < 0 ? negative : positive}`;
  };
  return `Head ${part(yaw, "left", "right")}, ${part(pitch, "down", "up")}`;
}
