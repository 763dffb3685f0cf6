// SPDX-License-Identifier: Apache-2.0
// Plays a live stream of sound.
import { numbersOf, sampleRate } from "../mtp";
import type { Server, Stream } from "../server";
import { SoundPlayer } from "../views/sound_player";
import { channelsOf } from "../views/spectrum";

export class Ears {
  private readonly player = new SoundPlayer();
  private readonly stream: Stream;

  constructor(server: Server, port: string) {
    this.stream = server.stream(port);
    this.stream.on("message", ({ message }) => {
      const { type, scalar, components, coord } = message.header;
      if (type !== "sound") return;
      const channels = channelsOf(numbersOf(message), scalar, components).slice(0, 2);
      this.player.play(channels, sampleRate(coord));
    });
  }

  close(): void {
    this.stream.close();
    this.player.close();
  }
}
