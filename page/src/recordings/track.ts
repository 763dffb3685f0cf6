// SPDX-License-Identifier: Apache-2.0
// One stream of a recording: a file of messages, and where in it each of them is.
import { Reader, readMessage, type Message } from "../mtp";

/** Numbers that are added one by one. */
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
  private readonly starts = new Column(); // [byte]
  private readonly times = new Column(); // [s since 1970]
  private end = 0;

  private constructor(
    /** MODULE.PORT */
    readonly port: string,
    private readonly file: Blob,
  ) {}

  /**
   * Reads a file through once, and keeps where its messages are and when.
   *
   * @param progress  called with the part that has been read, 0 … 1.
   * Errors: MtpError where a message is malformed. A truncated last message is ignored: the
   * recording may have been interrupted.
   */
  static async open(
    port: string,
    file: Blob,
    progress: (part: number) => void = () => {},
  ): Promise<Track> {
    const track = new Track(port, file);
    const reader = new Reader();
    let read = 0;
    const pieces = file.stream().getReader();
    for (;;) {
      const { done, value } = await pieces.read();
      if (done) return track;
      reader.push(value as Uint8Array<ArrayBuffer>);
      for (let message; (message = reader.next());) track.add(message, reader.byte);
      read += value.length;
      progress(read / file.size);
    }
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

  /** Bytes of a message in the middle. */
  get usualBytes(): number {
    return this.length === 0 ? 0 : this.end / this.length;
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

  /** Reads a message from the file. */
  async message(index: number): Promise<Message> {
    const end = index + 1 < this.length ? this.starts.at(index + 1) : this.end;
    const bytes = await this.file.slice(this.starts.at(index), end).arrayBuffer();
    return readMessage(new Uint8Array(bytes));
  }

  private add({ header }: Message, end: number): void {
    const time = Number(header.time) / 1e9;
    // Times that go back, or that are not given, count as those before, so that they can be searched.
    const before = this.length > 0 ? this.lastTime : 0;
    this.starts.push(this.end);
    this.times.push(Math.max(time, before));
    this.end = end;
  }
}
