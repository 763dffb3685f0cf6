// SPDX-License-Identifier: Apache-2.0
// One stream of a recording: the times of its messages, and how to read them.
import { Reader, readMessage, type Message } from "../mtp";
import type { Output } from "../outputs";

/** A growing array of numbers. */
class Column {
  private numbers = new Float64Array(256);
  length = 0;

  push(value: number): void {
    if (this.length === this.numbers.length) {
      const grown = new Float64Array(2 * this.length);
      grown.set(this.numbers);
      this.numbers = grown;
    }
    this.numbers[this.length++] = value;
  }

  at(index: number): number {
    return this.numbers[index]!;
  }
}

export class Track {
  private readonly times = new Column(); // [s since 1970]
  private bytes = 0;

  constructor(
    /** MODULE.PORT */
    readonly port: string,
    /** Reads a message. */
    readonly message: (index: number) => Promise<Message>,
    /** The outputs of its module; empty without a recorded description. */
    readonly outputs: readonly Output[] = [],
  ) {}

  /** Adds a message. @param bytes  its size. */
  add(time: number, bytes: number): void {
    // Missing or decreasing times count as the previous one, so that times can be searched.
    this.times.push(this.length > 0 ? Math.max(time, this.lastTime) : time);
    this.bytes += bytes;
  }

  get length(): number {
    return this.times.length;
  }

  /** Time of the first message [s since 1970]. */
  get firstTime(): number {
    return this.times.at(0);
  }

  get lastTime(): number {
    return this.times.at(this.length - 1);
  }

  timeAt(index: number): number {
    return this.times.at(index);
  }

  /** Size of a message in the middle [byte]. */
  get usualBytes(): number {
    return this.length === 0 ? 0 : this.bytes / this.length;
  }

  /** Index of the last message at or before a time; -1: none. */
  indexAt(time: number): number {
    let [low, high] = [0, this.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.times.at(middle) <= time) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }
}

/**
 * Indexes a file of messages by time, in one pass.
 *
 * @param progress  called with the part that has been read, 0 … 1.
 * Errors: MtpError if a message is malformed. A truncated last message is ignored, since the
 * recording may have been interrupted.
 */
export async function openMessages(
  port: string,
  file: Blob,
  progress: (part: number) => void = () => {},
): Promise<Track> {
  const ends = new Column(); // [byte]
  const track = new Track(port, async (index) => {
    const begin = index > 0 ? ends.at(index - 1) : 0;
    const bytes = await file.slice(begin, ends.at(index)).arrayBuffer();
    return readMessage(new Uint8Array(bytes));
  });
  const reader = new Reader();
  let [read, end] = [0, 0];
  const pieces = file.stream().getReader();
  for (;;) {
    const { done, value } = await pieces.read();
    if (done) return track;
    reader.push(value as Uint8Array<ArrayBuffer>);
    for (let message; (message = reader.next()); end = reader.byte) {
      ends.push(reader.byte);
      track.add(Number(message.header.time) / 1e9, reader.byte - end);
    }
    read += value.length;
    progress(read / file.size);
  }
}
