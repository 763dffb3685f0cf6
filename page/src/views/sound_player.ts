// SPDX-License-Identifier: Apache-2.0
const ahead = 0.08; // buffered sound, against gaps [s]

/** Plays consecutive pieces of sound. */
export class SoundPlayer {
  private readonly context = new AudioContext();
  private next = 0;

  constructor() {
    void this.context.resume();
  }

  play(channels: readonly Float32Array<ArrayBuffer>[], rate: number): void {
    const count = channels[0]?.length ?? 0;
    if (count === 0) return;
    const buffer = this.context.createBuffer(channels.length, count, rate);
    channels.forEach((samples, i) => buffer.copyToChannel(samples, i));
    const now = this.context.currentTime;
    if (this.next > now + 0.5) return; // it would delay all later pieces
    if (this.next < now) this.next = now + ahead;
    const source = this.context.createBufferSource();
    source.buffer = buffer;
    source.connect(this.context.destination);
    source.start(this.next);
    this.next += buffer.duration;
  }

  close(): void {
    void this.context.close();
  }
}
