// SPDX-License-Identifier: Apache-2.0
// Plays a stream of sound as it comes.
import { numbersOf, sampleRate, type Message } from "../mtp";
import type { Server, Stream } from "../server";

/** So much is played later, to be ready for what comes late; what is beyond the most is skipped [s]. */
const delay = 0.08;
const most = 0.5;

/** What one step of an integer sample is, and where its silence is. */
const ranges: Record<string, { scale: number; silence: number }> = {
  u8: { scale: 1 / 128, silence: 128 },
  i8: { scale: 1 / 128, silence: 0 },
  u16: { scale: 1 / 32768, silence: 32768 },
  i16: { scale: 1 / 32768, silence: 0 },
  i32: { scale: 2 ** -31, silence: 0 },
};

export class Ears {
  private readonly context = new AudioContext();
  private readonly stream: Stream;
  private next = 0;

  constructor(server: Server, port: string) {
    void this.context.resume();
    this.stream = server.stream(port);
    this.stream.on("message", ({ message }) => this.play(message));
  }

  close(): void {
    this.stream.close();
    void this.context.close();
  }

  private play(message: Message): void {
    const { header } = message;
    const frames = header.width * header.height;
    if (header.type !== "sound" || frames === 0) return;
    const now = this.context.currentTime;
    if (this.next > now + most) return;
    const channels = Math.min(2, header.components);
    const buffer = this.context.createBuffer(channels, frames, sampleRate(header.coord));
    const numbers = numbersOf(message);
    const { scale, silence } = ranges[header.scalar] ?? { scale: 1, silence: 0 };
    for (let channel = 0; channel < channels; ++channel) {
      const samples = buffer.getChannelData(channel);
      for (let i = 0; i < frames; ++i) {
        samples[i] = (numbers[i * header.components + channel]! - silence) * scale;
      }
    }
    const source = this.context.createBufferSource();
    source.buffer = buffer;
    source.connect(this.context.destination);
    this.next = Math.max(this.next, now + delay);
    source.start(this.next);
    this.next += buffer.duration;
  }
}
