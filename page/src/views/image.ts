// SPDX-License-Identifier: Apache-2.0
// Images in colour and grey.
import { Coord, headerOf, type Header } from "../mtp";
import type { Arrival } from "../server";
import { People, PeopleLayer } from "../people";
import { h } from "../shell/h";
import { isImage, isMeasured, PictureDecoder } from "./picture";
import { pixelAt, Probe } from "./probe";
import { askForWidth } from "./room";
import type { View, ViewHost, ViewKind } from "./view";

export class ImageView implements View {
  readonly element: HTMLElement;
  private readonly canvas = h("canvas.picture", { role: "img" });
  private readonly context = this.canvas.getContext("2d", { alpha: false })!;
  private readonly pixel = h("canvas", { width: 1, height: 1 }).getContext("2d", {
    willReadFrequently: true,
  })!;
  private readonly decoder: PictureDecoder;
  private readonly probe: Probe;
  private readonly layer = new PeopleLayer();
  private readonly people: People;
  private isDue = false; // what is new of people
  private readonly endRoom: () => void;
  private shown?: { arrival: Arrival; sent: Header };
  private turns = 0;
  private shownTurn = 0;

  constructor(private readonly host: ViewHost) {
    this.decoder = new PictureDecoder(() => host.source.restart?.());
    this.canvas.setAttribute("aria-label", `Image of ${host.source.port}`);
    this.probe = new Probe(this.canvas, ({ across, down }) => {
      const { sent } = this.shown ?? {};
      if (!sent) return "";
      const { x, y } = pixelAt({ across, down }, sent.width, sent.height);
      const [r, g, b] = this.colourAt(across * this.canvas.width, down * this.canvas.height);
      return `${x.toFixed(0)}, ${y.toFixed(0)} px  ${sent.components === 1 ? r : `${r} ${g} ${b}`}`;
    });
    this.element = h("div.image-view.stack", [this.canvas, this.layer.element, this.probe.output]);
    this.people = new People(host.surroundings);
    this.people.onChange(() => {
      if (this.isDue) return;
      this.isDue = true;
      requestAnimationFrame(() => this.drawPeople());
    });
    this.endRoom = askForWidth(this.canvas, host.source, () => this.shown?.sent);
  }

  async show(arrival: Arrival, sent: Header): Promise<void> {
    const turn = ++this.turns;
    const picture = await this.decoder.decode(arrival.message, sent);
    if (!picture) return;
    if (turn > this.shownTurn) {
      this.shownTurn = turn;
      const [width, height] =
        "displayWidth" in picture
          ? [picture.displayWidth, picture.displayHeight]
          : [picture.width, picture.height];
      if (this.canvas.width !== width || this.canvas.height !== height) {
        Object.assign(this.canvas, { width, height });
      }
      this.context.drawImage(picture, 0, 0);
      this.shown = { arrival, sent };
      this.drawPeople();
      this.probe.update();
    }
    picture.close();
  }

  /** Draws who is seen over the left eye's images, in which they are found. */
  private drawPeople(): void {
    this.isDue = false;
    const { sent, arrival } = this.shown ?? {};
    if (!sent || !arrival) return;
    const { coord } = sent;
    if (coord !== Coord.left_image && coord !== Coord.left_rectified) return;
    this.people.follow(this.host.source.port);
    this.layer.show(this.people.at(arrival.message.header.time || sent.time, coord), sent);
  }

  /** Red, green, blue [0, 255] of a pixel of the canvas. */
  private colourAt(x: number, y: number): Uint8ClampedArray {
    // Via a canvas of one pixel, so that the large one can stay in GPU memory.
    this.pixel.drawImage(this.canvas, Math.floor(x), Math.floor(y), 1, 1, 0, 0, 1, 1);
    return this.pixel.getImageData(0, 0, 1, 1).data;
  }

  async snapshot(): Promise<Arrival | undefined> {
    const { shown, canvas } = this;
    if (!shown) return undefined;
    const blob = await new Promise<Blob | null>((resolve) =>
      canvas.toBlob(resolve, "image/jpeg", 0.8),
    );
    if (!blob) return undefined;
    const { src, dst, seq, ttl, time, mode, coord } = shown.sent;
    const kind = { type: "rgb_image", components: 3, scalar: "u8", encoding: "jpeg" } as const;
    const other = {
      src,
      dst,
      seq,
      ttl,
      time: shown.arrival.message.header.time || time,
      mode,
      coord,
    };
    const header = headerOf(kind, canvas.width, canvas.height, other);
    const elements = new Uint8Array(await blob.arrayBuffer());
    return { message: { header, elements }, at: shown.arrival.at, bytes: elements.length };
  }

  close(): void {
    this.endRoom();
    this.people.close();
    this.decoder.close();
  }
}

export const imageView: ViewKind = {
  name: "image",
  fits: (sent) => isImage(sent) && !isMeasured(sent),
  make: (host) => new ImageView(host),
};
