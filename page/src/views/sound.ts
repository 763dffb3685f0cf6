// SPDX-License-Identifier: Apache-2.0
// Sound as levels and a spectrum over time, and playback.
import { numbersOf, sampleRate, type Header } from "../mtp";
import type { Arrival } from "../server";
import { h, setText } from "../shell/h";
import { SoundPlayer } from "./sound_player";
import { Sight } from "./room";
import { channelsOf, level, spectrum } from "./spectrum";
import { turbo } from "./turbo";
import type { View, ViewKind } from "./view";

const frames = 512; // sample frames of one spectrum
const floor = -70; // [dB], shown as black

export class SoundView implements View {
  readonly element: HTMLElement;
  readonly runsUnseen = true;
  readonly tools: readonly HTMLElement[];
  private readonly listen = h("button", { "aria-pressed": "false" }, "Listen");
  private readonly levels = h("div.levels");
  private readonly picture = h("canvas.waterfall", {
    width: 600,
    height: frames / 2,
    role: "img",
    "aria-label": "Spectrum over the last seconds, low frequencies at the bottom",
  });
  private readonly context = this.picture.getContext("2d", { alpha: false })!;
  private readonly highest = h("span.mono");
  private readonly sight: Sight;
  private readonly samples = new Float32Array(frames);
  private fresh = 0;
  private player?: SoundPlayer;
  private meters: { meter: HTMLMeterElement; words: HTMLElement }[] = [];
  private metered = 0;

  constructor() {
    this.listen.onclick = () => this.setListening(!this.player);
    this.tools = [this.listen];
    this.element = h("div.sound-view.stack", [
      this.levels,
      this.picture,
      h("div.small.muted", [
        "from 0 Hz, at the bottom, to ",
        this.highest,
        `; ${floor} dB blue, 0 dB red`,
      ]),
    ]);
    this.sight = new Sight(this.element);
  }

  show({ message }: Arrival, sent: Header): void {
    const { components, scalar, coord } = message.header;
    const rate = sampleRate(coord || sent.coord);
    const channels = channelsOf(numbersOf(message), scalar, components);
    this.player?.play(channels, rate);
    if (!this.sight.isSeen) return;
    this.showLevels(channels);
    const words = `${rate / 2} Hz`;
    setText(this.highest, words);
    if (channels[0]) this.add(channels[0]);
  }

  close(): void {
    this.setListening(false);
    this.sight.close();
  }

  private setListening(on: boolean): void {
    this.player?.close();
    this.player = on ? new SoundPlayer() : undefined;
    this.listen.setAttribute("aria-pressed", String(on));
  }

  private showLevels(channels: readonly Float32Array[]): void {
    if (performance.now() - this.metered < 50) return;
    this.metered = performance.now();
    if (this.meters.length !== channels.length) {
      this.meters = channels.map((_, i) => ({
        meter: h("meter", {
          min: floor,
          max: 0,
          low: -60,
          high: -6,
          "aria-label": `Level of channel ${i}`,
        }),
        words: h("span.mono"),
      }));
      this.levels.replaceChildren(
        ...this.meters.map(({ meter, words }, i) => h("div", [`channel ${i} `, meter, " ", words])),
      );
    }
    channels.forEach((samples, i) => {
      const { meter, words } = this.meters[i]!;
      const decibels = level(samples);
      meter.value = decibels;
      words.textContent = decibels <= -100 ? "silent" : `${decibels.toFixed(0)} dB`;
    });
  }

  /** Adds samples, and a column to the picture for each half window. */
  private add(samples: Float32Array): void {
    for (let at = 0; at < samples.length;) {
      const piece = samples.subarray(at, at + frames / 2 - this.fresh);
      at += piece.length;
      this.samples.copyWithin(0, piece.length);
      this.samples.set(piece, frames - piece.length);
      this.fresh += piece.length;
      if (this.fresh < frames / 2) return;
      this.fresh = 0;
      this.drawColumn();
    }
  }

  private drawColumn(): void {
    const { width, height } = this.picture;
    this.context.drawImage(this.picture, -1, 0);
    const column = this.context.createImageData(1, height);
    spectrum(this.samples).forEach((decibels, i) => {
      const at = 4 * (height - 1 - i);
      const colour = decibels <= floor ? [16, 16, 16] : turbo(1 - decibels / floor);
      column.data.set([...colour, 255], at);
    });
    this.context.putImageData(column, width - 1, 0);
  }
}

export const soundView: ViewKind = {
  name: "sound",
  fits: (sent) => sent.type === "sound",
  make: () => new SoundView(),
};
