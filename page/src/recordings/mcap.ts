// SPDX-License-Identifier: Apache-2.0
// Streams of messages in an MCAP file (doc/recordings.md, "In the file"; https://mcap.dev/spec).
import { parseDescription } from "../graph/describe";
import { elementsOf, parseHeader, type Message } from "../mtp";
import { outputsIn, type Output } from "../outputs";
import { moduleOf } from "../server";
import { Track } from "./track";
import { expandZstd } from "./zstd";

const magic = Uint8Array.of(0x89, 0x4d, 0x43, 0x41, 0x50, 0x30, 0x0d, 0x0a);
const tailBytes = 9 + 20 + magic.length; // the footer's record and the magic
const mostBytes = 2 ** 30; // of a chunk, expanded
const mostCompanions = 1000; // searched before and after a message
const opcodes = { channel: 4, chunkIndex: 8, metadataIndex: 13 };
const descriptionPrefix = "hypercolumn.description."; // of metadata, before the module's name

/** Reads consecutive numbers and texts; throws RangeError beyond the end. */
class Fields {
  private at = 0;
  private readonly view: DataView<ArrayBuffer>;

  constructor(readonly bytes: Uint8Array<ArrayBuffer>) {
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  }

  get left(): number {
    return this.bytes.length - this.at;
  }
  u8(): number {
    return this.view.getUint8(this.move(1));
  }
  u16(): number {
    return this.view.getUint16(this.move(2), true);
  }
  u32(): number {
    return this.view.getUint32(this.move(4), true);
  }
  u64(): number {
    return Number(this.view.getBigUint64(this.move(8), true));
  }
  take(size: number): Uint8Array<ArrayBuffer> {
    const begin = this.move(size);
    return this.bytes.subarray(begin, begin + size);
  }
  text(): string {
    return new TextDecoder().decode(this.take(this.u32()));
  }
  /** The contents of a list or map. */
  list(): Fields {
    return new Fields(this.take(this.u32()));
  }
  record(): { opcode: number; content: Fields } {
    return { opcode: this.u8(), content: new Fields(this.take(this.u64())) };
  }
  /** Skips to a multiple of 4, as in CDR after its first four bytes. */
  align(): void {
    this.move(-this.at & 3);
  }

  private move(size: number): number {
    if (size > this.left) throw new RangeError("The recording is damaged: truncated record.");
    const begin = this.at;
    this.at += size;
    return begin;
  }
}

/** The texts of a map, by their keys. */
function wordsIn(map: Fields): Map<string, string> {
  const words = new Map<string, string>();
  while (map.left > 0) words.set(map.text(), map.text());
  return words;
}

/** A chunk, from the summary. */
interface Chunk {
  readonly end: number; // end of its record in the file [byte]
  readonly indexBytes: number; // of its index records, which follow it
  readonly compression: string;
  readonly stored: number; // size of its messages in the file [byte]
  readonly plain: number;
}

interface Channel {
  /** Of MTP messages. */
  readonly stream?: Stream;
  /** Of companions: topic of their messages. */
  readonly companion?: string;
}

/** A stream, and the places of its messages and companions, which may be in different chunks. */
interface Stream {
  readonly track: Track;
  readonly places: Place[];
  readonly companions: Place[]; // by log time, then by position in the file
}

/** The place of a message. */
interface Place {
  readonly chunk: Chunk;
  readonly offset: number; // in its chunk
  readonly number: number; // index in the file
  readonly time: number; // [s since 1970]
  readonly bytes: number;
}

/** Companions with the log time of a message, the nearest in the file first. */
function* companionsNear({ time, number }: Place, companions: readonly Place[]): Generator<Place> {
  let [low, high] = [0, companions.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    const other = companions[middle]!;
    if (other.time < time || (other.time === time && other.number < number)) low = middle + 1;
    else high = middle;
  }
  for (let i = 0; i < mostCompanions; ++i) {
    const near = [companions[low - 1 - i], companions[low + i]].filter(
      (other) => other?.time === time,
    );
    if (near.length === 0) return;
    yield* near as Place[];
  }
}

class McapFile {
  private readonly channels = new Map<number, Channel>();
  private readonly chunks: Chunk[] = [];
  private readonly companions = new Map<string, Place[]>(); // by topic of MTP
  private messages = 0;
  private newest?: { readonly chunk: Chunk; readonly bytes: Promise<Uint8Array<ArrayBuffer>> };

  constructor(private readonly file: Blob) {}

  /** Reads the summary, and the index of each chunk. */
  async index(progress: (part: number) => void): Promise<Track[]> {
    const isMagic = (bytes: Uint8Array) => magic.every((byte, i) => byte === bytes[i]);
    if (!isMagic((await this.read(0, magic.length)).bytes))
      throw new Error("This is not an MCAP file.");
    const footerAt = Math.max(0, this.file.size - tailBytes);
    const tail = await this.read(footerAt, tailBytes);
    const hasEnd = tail.left === tailBytes && isMagic(tail.bytes.subarray(-magic.length));
    const summaryAt = hasEnd ? tail.record().content.u64() : 0;
    if (summaryAt === 0)
      throw new Error(
        "This recording has no end, probably because its recorder was killed; " +
          "repair it with hc record cut.mcap whole.mcap.",
      );
    const summary = await this.read(summaryAt, footerAt - summaryAt);
    const channels: Fields[] = [];
    const outputs = new Map<string, Output[]>();
    while (summary.left > 0) {
      const { opcode, content } = summary.record();
      if (opcode === opcodes.channel) channels.push(content);
      if (opcode === opcodes.chunkIndex) this.addChunk(content);
      if (opcode === opcodes.metadataIndex) await this.readMetadata(content, outputs);
    }
    for (const content of channels) this.addChannel(content, outputs);
    this.chunks.sort((a, b) => a.end - b.end);
    for (const [i, chunk] of this.chunks.entries()) {
      this.addMessages(chunk, await this.read(chunk.end, chunk.indexBytes));
      progress((i + 1) / this.chunks.length);
    }
    const streams = [...this.channels.values()].flatMap(({ stream }) => stream ?? []);
    for (const list of this.companions.values()) list.sort((a, b) => a.time - b.time);
    for (const { track, places, companions } of streams)
      for (const place of places) {
        const [companion] = companionsNear(place, companions);
        track.add(place.time, place.bytes + (companion?.bytes ?? 0));
      }
    return streams.map(({ track }) => track);
  }

  private async read(begin: number, size: number): Promise<Fields> {
    return new Fields(new Uint8Array(await this.file.slice(begin, begin + size).arrayBuffer()));
  }

  /** Reads the outputs of a module, if this is the index of its description. */
  private async readMetadata(index: Fields, outputs: Map<string, Output[]>): Promise<void> {
    const [begin, size] = [index.u64(), index.u64()];
    const name = index.text();
    if (!name.startsWith(descriptionPrefix)) return;
    const { content } = (await this.read(begin, size)).record();
    content.text(); // the name again
    const words = wordsIn(content.list());
    const module = name.slice(descriptionPrefix.length);
    outputs.set(module, outputsIn(module, parseDescription(words.get("json") ?? "")));
  }

  private addChannel(content: Fields, outputs: ReadonlyMap<string, Output[]>): void {
    const id = content.u16();
    content.u16();
    const topic = content.text();
    content.text();
    const words = wordsIn(content.list());
    const name = words.get("hypercolumn.stream");
    const [places, companions] = [[] as Place[], this.companionsOf(topic)];
    const track = new Track(
      name ?? "",
      (index) => this.message(topic, places[index]!, companions),
      outputs.get(moduleOf(name ?? "")),
    );
    const stream = name === undefined ? undefined : { track, places, companions };
    this.channels.set(id, { stream, companion: words.get("hypercolumn.mtp") });
  }

  private companionsOf(topic: string): Place[] {
    const known = this.companions.get(topic) ?? [];
    this.companions.set(topic, known);
    return known;
  }

  private addChunk(content: Fields): void {
    content.take(16); // first and last time
    const end = content.u64() + content.u64();
    content.list(); // offsets of the channels' indexes
    const indexBytes = content.u64();
    const compression = content.text();
    this.chunks.push({ end, indexBytes, compression, stored: content.u64(), plain: content.u64() });
  }

  /** Adds the messages of a chunk, from its index. */
  private addMessages(chunk: Chunk, indexes: Fields): void {
    const entries: { time: number; offset: number; channel: Channel | undefined }[] = [];
    while (indexes.left > 0) {
      const { content } = indexes.record();
      const channel = this.channels.get(content.u16());
      for (const list = content.list(); list.left > 0;)
        entries.push({ time: list.u64() / 1e9, offset: list.u64(), channel });
    }
    entries.sort((a, b) => a.offset - b.offset);
    entries.forEach(({ time, offset, channel }, i) => {
      const bytes = (entries[i + 1]?.offset ?? chunk.plain) - offset;
      const place: Place = { chunk, offset, number: this.messages++, time, bytes };
      channel?.stream?.places.push(place);
      if (channel?.companion !== undefined) this.companionsOf(channel.companion).push(place);
    });
  }

  /** The messages of a chunk, decompressed. */
  private contents(chunk: Chunk): Promise<Uint8Array<ArrayBuffer>> {
    if (this.newest?.chunk !== chunk) this.newest = { chunk, bytes: this.expand(chunk) };
    return this.newest.bytes;
  }

  private async expand({ end, compression, stored, plain }: Chunk) {
    if (plain > mostBytes) throw new Error("A chunk of this recording is too large for the page.");
    const { bytes } = await this.read(end - stored, stored);
    if (compression === "") return bytes;
    if (compression === "zstd") return expandZstd(bytes, plain);
    throw new Error(`This recording has an unsupported compression: ${compression}.`);
  }

  private async stored({ chunk, offset }: Place) {
    const contents = await this.contents(chunk);
    const { content } = new Fields(contents.subarray(offset)).record();
    content.u16();
    const sequence = content.u32();
    content.take(16);
    return { sequence, data: content.take(content.left) };
  }

  private async message(topic: string, place: Place, companions: Place[]): Promise<Message> {
    const { sequence, data } = await this.stored(place);
    // hypercolumn_msgs/msg/Matrix in CDR.
    const matrix = new Fields(data);
    matrix.take(4);
    const line = matrix.text().replace(/\0$/, "");
    matrix.align();
    const [from, size] = [matrix.u32(), matrix.u32()];
    let bytes = matrix.take(matrix.u32());
    if (from > 0) {
      let other;
      for (const each of companionsNear(place, companions))
        if ((other = await this.stored(each)).sequence === sequence) break;
      if (other?.sequence !== sequence || from + size > other.data.length)
        throw new Error(`A message of ${topic} lacks its elements.`);
      bytes = other.data.subarray(from, from + size);
    }
    const header = parseHeader(line, 0, mostBytes);
    const isCompressed = header.encoding === "zstd" || header.encoding === "jpeg";
    return { header, elements: isCompressed ? bytes : elementsOf(header.scalar, bytes) };
  }
}

/**
 * Opens the streams of an MCAP file.
 *
 * @param progress  called with the part that has been read, 0 … 1.
 * Errors: not an MCAP file, damaged, or without an end.
 */
export function openMcap(
  file: Blob,
  progress: (part: number) => void = () => {},
): Promise<Track[]> {
  return new McapFile(file).index(progress);
}
