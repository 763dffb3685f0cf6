// SPDX-License-Identifier: Apache-2.0
// The images of the robot's eyes in the seat: a canvas and its streams.
import { moduleOf, type GraphState, type Server } from "../server";
import { button, fill, h } from "../shell";
import { SlowRange } from "../views/coding";
import { eyePairs, labelsOf, type EyePair } from "../eyes";
import { PeopleLayer, type People, type Person } from "../people";
import { Pairing, type Side } from "../views/pairing";
import { Eye, type Picture } from "./eye";
import type { Latency } from "./latency";
import { drawPictures, thumbnailOf, type Pictures } from "./picture";
import { silenceText, waiting } from "./silence";
import { pixelAt, placesOf, sidesOf, wayNames, ways, type Way } from "./places";
import type { XrView } from "./xr";

/** Maximum width of requested images [px]. */
const widest = 1280;
/** After this time without an image of an eye, a headset shows the other one alone [ms]. */
const patience = 1000;

const close = ({ bitmap }: Picture): void => bitmap.close();

export class SeatView {
  readonly canvas = h("canvas.seat-image", { role: "img", "aria-label": "What the robot sees" });
  private readonly layer = new PeopleLayer();
  private readonly problem = h("p.seat-problem", { role: "status" });
  private readonly way: HTMLSelectElement;
  /** The modules whose images can be shown. */
  private readonly sources = h("div.chips", { role: "group", "aria-label": "Whose images" });
  private readonly coding = h("select", {
    "aria-label": "How depth is shown",
    onchange: () => this.choose(this.module, this.coding.value),
  });
  /** What has been chosen: a module, and of depths their coding. */
  private module = "";
  readonly element: HTMLElement;
  private readonly eyes = new Map<Side, Eye>();
  /** The images shown. */
  private pictures: Pictures = {};
  private readonly pairing = new Pairing<Picture>(close);
  /** When each eye's last image came, or its stream was opened. */
  private readonly came: Record<Side, number> = { left: 0, right: 0 };
  /** The last text about missing images. */
  private silence = "";
  /** When images were shown last, or their streams were opened. */
  private shown = 0;
  private pairs: readonly EyePair[] = [];
  private readonly resizing: ResizeObserver;
  private drawing = false;
  private readonly endPeople: () => void;
  private xr?: XrView;

  constructor(
    private readonly server: Server,
    private readonly latency: Latency,
    private readonly people: People,
  ) {
    this.way = h(
      "select",
      { "aria-label": "How the eyes are shown", onchange: () => this.reopen() },
      ways.map((way) => h("option", { value: way }, wayNames[way])),
    );
    const tools = h("div.seat-tools.wrap", [this.sources, this.way, this.coding]);
    this.element = h("div.seat-view", [this.canvas, this.layer.element, tools, this.problem]);
    this.resizing = new ResizeObserver(() => this.resize());
    this.resizing.observe(this.canvas);
    this.endPeople = people.onChange(() => this.draw());
  }

  close(): void {
    this.resizing.disconnect();
    this.endPeople();
    this.xr = undefined; // its session ends later, and then opens nothing
    this.pairs = [];
    this.shut();
  }

  /** Updates the pairs of eyes in the graph. */
  update(state: GraphState): void {
    const pairs = eyePairs(state);
    if (this.pair) this.people.follow(this.pair.left);
    this.watch(state);
    if (JSON.stringify(pairs) === JSON.stringify(this.pairs)) return;
    this.pairs = pairs;
    const chips = [...labelsOf(pairs)].map(([module, label]) =>
      button(label, () => this.choose(module), { "data-module": module, title: `From ${module}` }),
    );
    fill(this.sources, chips);
    const isThere = pairs.some(({ module }) => module === this.module);
    this.choose(isThere ? this.module : (pairs[0]?.module ?? ""), this.coding.value);
  }

  /** Says that no images come, and which module is the reason. */
  private watch(state: GraphState): void {
    const { pair, pictures } = this;
    if (!pair || this.eyes.size === 0) return;
    const sides = [...this.eyes.keys()].sort((a, b) => this.came[a] - this.came[b]);
    const port = (sides[0] === "right" && pair.right) || pair.left;
    const hasImage = (pictures.left ?? pictures.right) !== undefined;
    const text = silenceText(hasImage, performance.now() - this.shown, state, port);
    this.element.toggleAttribute("data-old", hasImage && text !== "");
    if ([this.silence, ""].includes(this.problem.textContent)) this.problem.textContent = text;
    this.silence = text;
  }

  /** Shows the images of a module. */
  private choose(module: string, coding = ""): void {
    this.module = module;
    for (const chip of this.sources.querySelectorAll("button"))
      chip.setAttribute("aria-pressed", String(chip.dataset.module === module));
    const codings = this.choices.flatMap((pair) => pair.coding ?? []);
    fill(
      this.coding,
      codings.map((each) => h("option", { selected: each === coding }, each)),
    );
    this.coding.hidden = codings.length === 0;
    this.reopen();
  }

  /** The pairs of the chosen module. */
  private get choices(): readonly EyePair[] {
    return this.pairs.filter(({ module }) => module === this.module);
  }

  get pair(): EyePair | undefined {
    const { choices } = this;
    return choices.find(({ coding }) => coding === this.coding.value) ?? choices[0];
  }

  /** Focal length of the cameras, from the graph's parameters [px of the sensor]. */
  get focal(): number {
    const modules = this.server.state?.modules ?? [];
    const { pair } = this;
    const camera = pair?.images?.[0] ? moduleOf(pair.images[0]) : pair?.module;
    const own = modules.find((module) => module.name === camera)?.parameters.focal;
    return Number(own) || 600;
  }

  /** The sensor pixel of an eye under a point of the window, and the time of that image [ns];
   *  undefined outside unprocessed camera images. */
  pixelAt(clientX: number, clientY: number) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const { pictures } = this;
    const image = pictures.left ?? pictures.right;
    if (!image || !this.pair?.raw) return undefined;
    const { canvas } = this;
    const point = {
      x: ((clientX - left) * canvas.width) / width,
      y: ((clientY - top) * canvas.height) / height,
    };
    const found = pixelAt(placesOf(this.shownWay, image.bitmap, canvas), point, image);
    const picture = found && pictures[found.side];
    if (!found || !picture || (picture.coord !== 7 && picture.coord !== 8)) return undefined;
    return { x: found.x, y: found.y, coord: picture.coord, time: picture.time };
  }

  /** The person in the image at a point of the window. */
  personAt(clientX: number, clientY: number): Person | undefined {
    return this.layer.personAt(clientX, clientY);
  }

  /** Also shows the images in a headset; `undefined` ends that. */
  showIn(xr: XrView | undefined): void {
    this.xr = xr;
    this.reopen();
  }

  private get shownWay(): Way {
    return ways.find((way) => way === this.way.value) ?? "left";
  }

  /** Closes all streams. */
  private shut(): void {
    for (const eye of this.eyes.values()) eye.close();
    this.eyes.clear();
    this.pairing.close();
    this.replace({});
  }

  private replace(pictures: Pictures): void {
    const old = this.pictures;
    this.pictures = pictures;
    for (const side of ["left", "right"] as const)
      if (old[side] && old[side] !== pictures[side]) close(old[side]);
  }

  /** Opens the streams needed, and closes others. */
  private reopen(): void {
    this.shut();
    this.problem.textContent = "";
    const { pair } = this;
    if (!pair) {
      this.problem.textContent = "The graph has no module that sends images left or right.";
      return;
    }
    this.problem.textContent = this.silence = waiting;
    this.shown = performance.now();
    this.people.follow(pair.left);
    this.way.disabled = pair.right === undefined;
    const wanted = this.xr ? (["left", "right"] as const) : sidesOf(this.shownWay);
    const range = new SlowRange();
    for (const side of wanted) {
      this.came[side] = performance.now();
      const port = side === "left" ? pair.left : (pair.right ?? pair.left);
      const image = pair.images?.[side === "left" ? 0 : 1];
      const depth = pair.coding && { coding: pair.coding, image, range };
      const taken = (picture: Picture): void => this.take(side, picture, wanted.length === 1);
      const problem = (text: string): void => {
        this.problem.textContent = text || (this.pictures[side] ? "" : this.silence);
      };
      this.eyes.set(side, new Eye(this.server, port, this.width(), depth, taken, problem));
    }
  }

  /** Takes an image of an eye. @param isAlone  The other eye is not shown. */
  private take(side: Side, picture: Picture, isAlone: boolean): void {
    this.came[side] = performance.now();
    const since = this.came[side] - this.came[side === "left" ? "right" : "left"];
    const isOtherLost = this.xr !== undefined && since > patience;
    if (isOtherLost) this.pairing.close();
    const pictures =
      isAlone || isOtherLost ? { [side]: picture } : this.pairing.take(side, picture);
    if (!pictures) return;
    this.xr?.show(pictures);
    this.replace(pictures);
    this.show(picture);
  }

  /** Draws the pictures, and measures their latency by one of them. */
  private show(picture: Picture): void {
    this.shown = performance.now();
    if (this.problem.textContent === this.silence) this.problem.textContent = "";
    this.element.removeAttribute("data-old");
    const thumbnail = thumbnailOf(picture.bitmap);
    this.draw(() =>
      this.latency.shown({
        thumbnail,
        sensed: Number(picture.time / 1000n) / 1000,
        arrived: picture.arrived,
        decoded: picture.decoded,
        drawn: Date.now(),
      }),
    );
  }

  /** Draws at the next frame, then calls `drawn`. */
  private draw(drawn: () => void = () => {}): void {
    if (this.xr) return this.xr.nextFrame(drawn);
    if (!this.drawing) {
      this.drawing = true;
      requestAnimationFrame(() => {
        this.drawing = false;
        drawPictures(this.canvas, this.shownWay, this.pictures);
        this.drawPeople();
      });
    }
    requestAnimationFrame(drawn); // after drawing, since it was requested later
  }

  /** Width to request, in steps, to limit the number of requests. */
  private width(): number {
    if (this.xr) return widest;
    const across = this.shownWay === "side by side" ? 2 : 1;
    return Math.min(widest, Math.max(160, Math.ceil(this.canvas.width / across / 160) * 160));
  }

  private resize(): void {
    const { width, height } = this.canvas.getBoundingClientRect();
    const ratio = Math.min(2, devicePixelRatio);
    const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (w === 0 || h === 0 || (w === this.canvas.width && h === this.canvas.height)) return;
    this.canvas.width = w;
    this.canvas.height = h;
    for (const eye of this.eyes.values()) eye.setWidth(this.width());
    // At once, since resizing clears a canvas.
    drawPictures(this.canvas, this.shownWay, this.pictures);
    this.drawPeople();
  }

  /** Draws who is seen over the left eye's image, in which they were found. */
  private drawPeople(): void {
    const { canvas, pictures, layer } = this;
    const places = pictures.left ? placesOf(this.shownWay, pictures.left.bitmap, canvas) : [];
    const place = places.find(({ side }) => side === "left");
    layer.element.toggleAttribute("hidden", !place);
    if (!place || !pictures.left) return;
    const share = (part: number, whole: number): string => `${(100 * part) / whole}%`;
    Object.assign(layer.element.style, {
      left: share(place.x, canvas.width),
      top: share(place.y, canvas.height),
      width: share(place.width, canvas.width),
      height: share(place.height, canvas.height),
    });
    const { time, coord } = pictures.left;
    layer.show(this.people.at(time, coord), pictures.left);
  }
}
