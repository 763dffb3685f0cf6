// SPDX-License-Identifier: Apache-2.0
// The orientation of the robot's head over time, from the output that moves its frame.
import { numbersOf } from "../mtp";
import type { Server, Stream } from "../server";
import { framesOf } from "../views/frames";
import { anglesOfPose, type Angles } from "./orientation";

/** Maximum number of poses, which span some seconds. */
const most = 300;

/** The output that moves the frame `head`, in the text of G31. */
export function headOutput(frames: string): string | undefined {
  return framesOf(frames).find(({ name }) => name === "head")?.movedBy;
}

export class GazeHistory {
  private readonly stream: Stream;
  private readonly poses: { time: bigint; angles: Angles }[] = [];

  constructor(server: Server, port: string) {
    this.stream = server.stream(port);
    this.stream.on("message", ({ message }) => {
      if (message.header.type !== "transformation") return;
      const { time } = message.header;
      this.poses.push({ time, angles: anglesOfPose(numbersOf(message)) });
      if (this.poses.length > most) this.poses.shift();
    });
  }

  /** The pose nearest in time. */
  at(time: bigint): Angles | undefined {
    const away = (pose: { time: bigint }): number => Math.abs(Number(pose.time - time));
    return this.poses.length === 0
      ? undefined
      : this.poses.reduce((a, b) => (away(b) <= away(a) ? b : a)).angles;
  }

  close(): void {
    this.stream.close();
  }
}
