// SPDX-License-Identifier: Apache-2.0
// Follows the people and hands in the images of one camera.
import { Coord, type Message } from "../mtp";
import type { Output } from "../outputs";
import { moduleOf, Signal, type Emitter, type GraphState } from "../server";
import { peoplePorts, type PeoplePorts } from "./ports";
import { Recent } from "./recent";
import {
  attendedOf,
  facesOf,
  handsOf,
  namesOf,
  type Attended,
  type Face,
  type Hand,
} from "./tables";

/** A face, and the name of its person. */
export interface Person extends Face {
  /** The name, "person 3", or "?". */
  readonly name: string;
  /** Why the robot looks at this person, in words; empty: it does not. */
  readonly reason: string;
}

/** What is seen in an image. */
export interface Sighting {
  readonly people: readonly Person[];
  readonly hands: readonly Hand[];
}

/** The graph, as far as it is needed here. */
export interface PeopleHost {
  readonly state: GraphState | undefined;
  /** All outputs, as their modules describe them. */
  outputs(): Promise<readonly Output[]>;
  open(port: string): Pick<Emitter, "on" | "close">;
}

interface Rows<T> {
  readonly time: bigint;
  readonly coord: number;
  readonly rows: readonly T[];
}

/** Without a table of faces for so long, the image is empty; outputs that are unknown are asked
 *  for again [ms]. */
const patience = 2000;

/** Whether rows in one coordinate system are drawn over an image in another: a rectified image
 *  differs little from the camera's. */
function isOver(rows: number, image: number): boolean {
  return rows === image || (rows === Coord.left_rectified && image === Coord.left_image);
}

export class People {
  private ports: PeoplePorts = {};
  private streams: Pick<Emitter, "close">[] = [];
  private key = "";
  /** When to ask again for the outputs [ms]. */
  private again = Infinity;
  private readonly faces = new Recent<Rows<Face>>();
  private readonly hands = new Recent<Rows<Hand>>();
  private readonly attended = new Recent<Attended & { readonly time: bigint }>();
  private names = new Map<number, string>();
  private newest?: { readonly rows: Rows<Face>; readonly at: number };
  private opened = -Infinity; // by performance.now(), as newest [ms]
  private isClosed = false;
  private readonly changes = new Signal<void>();
  /** Something new is known. */
  readonly onChange = this.changes.on;

  constructor(private readonly host: PeopleHost) {}

  /** Follows the people in the images of an output, as the graph is now. */
  follow(image: string): void {
    const { state } = this.host;
    const modules = state?.modules.map(({ name, program }) => `${name} ${program}`) ?? [];
    const links = state?.links.map(({ from, to }) => `${from} ${to}`) ?? [];
    const key = [image, ...modules, ...links].join("\n");
    if (key === this.key && performance.now() < this.again) return;
    this.key = key;
    this.again = Infinity;
    void this.ask(image, key);
  }

  /** Whether the graph finds faces. */
  get findsFaces(): boolean {
    return this.ports.faces !== undefined;
  }

  /** The module that finds them. */
  get finder(): string {
    return moduleOf(this.ports.faces ?? "");
  }

  /** What is seen in an image of a time [ns] in a coordinate system. */
  at(time: bigint, coord: number): Sighting {
    const faces = this.faces.at(time);
    const hands = this.hands.at(time);
    return {
      people: faces && isOver(faces.coord, coord) ? this.peopleIn(faces) : [],
      hands: hands && isOver(hands.coord, coord) ? hands.rows : [],
    };
  }

  /** Whether the module sends nothing, as when it gets no processor. */
  get isLate(): boolean {
    return performance.now() - (this.newest?.at ?? this.opened) >= patience;
  }

  /** Who is seen now. */
  seen(): Person[] {
    const { newest } = this;
    return newest && !this.isLate ? this.peopleIn(newest.rows) : [];
  }

  close(): void {
    this.isClosed = true;
    this.shut();
  }

  private peopleIn({ time, rows }: Rows<Face>): Person[] {
    const attended = this.attended.at(time);
    return rows.map((face) => {
      const unnamed = face.person > 0 ? `person ${face.person}` : "?";
      const name = this.names.get(face.person) ?? unnamed;
      return { ...face, name, reason: attended?.track === face.track ? attended.reason : "" };
    });
  }

  private async ask(image: string, key: string): Promise<void> {
    const outputs = await this.host.outputs().catch(() => undefined);
    if (this.key !== key || this.isClosed) return;
    // A module that starts, or hangs, does not describe itself yet.
    const isWhole = outputs?.every(({ type }) => type !== "") ?? false;
    if (!isWhole) this.again = performance.now() + patience;
    if (outputs) this.open(peoplePorts(outputs, this.host.state?.links, image));
  }

  private shut(): void {
    for (const stream of this.streams.splice(0)) stream.close();
    this.faces.clear();
    this.hands.clear();
    this.attended.clear();
    this.names = new Map();
    this.newest = undefined;
  }

  private open(ports: PeoplePorts): void {
    if (JSON.stringify(ports) === JSON.stringify(this.ports)) return;
    this.shut();
    this.ports = ports;
    this.opened = performance.now();
    this.read(ports.faces, (message) => {
      const rows = { ...timeOf(message), rows: facesOf(message) };
      this.faces.push(rows);
      this.newest = { rows, at: performance.now() };
    });
    this.read(ports.hands, (message) => {
      this.hands.push({ ...timeOf(message), rows: handsOf(message) });
    });
    this.read(ports.attended, (message) => {
      const attended = attendedOf(message);
      if (attended) this.attended.push({ ...timeOf(message), ...attended });
    });
    this.read(ports.names, (message) => (this.names = namesOf(message)));
    this.changes.emit();
  }

  private read(port: string | undefined, take: (message: Message) => void): void {
    if (port === undefined) return;
    const stream = this.host.open(port);
    this.streams.push(stream);
    stream.on("message", ({ message }) => {
      take(message);
      this.changes.emit();
    });
  }
}

function timeOf({ header }: Message): { readonly time: bigint; readonly coord: number } {
  return { time: header.time, coord: header.coord };
}
