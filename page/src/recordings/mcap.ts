// SPDX-License-Identifier: Apache-2.0
// Streams of messages in a file of MCAP (doc/recordings.md, "In the file"; https://mcap.dev/spec).
import { elementsOf, parseHeader, type Message } from "../mtp";
import { Column, Track } from "./track";
import { expandZstd } from "./zstd";

const magic = Uint8Array.of(0x89, 0x4d, 0x43, 0x41, 0x50, 0x30, 0x0d, 0x0a);
const recordHead = 9; // an opcode and a length [byte]
const mostBytes = 2 ** 30; // of a chunk, expanded
const windowBytes = 2 ** 20;
const opcodes = { schema: 3, channel: 4, message: 5, chunk: 6, messageIndex: 7, dataEnd: 15 };

/** Reads the content of a record; throws RangeError behind its end. */
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
  /** A time [s]. */
  time(): number {
    return Number(this.view.getBigUint64(this.move(8), true)) / 1e9;
  }
  length(): number {
    return Number(this.view.getBigUint64(this.move(8), true));
  }
  take(size: number): Uint8Array<ArrayBuffer> {
    const begin = this.move(size);
    return this.bytes.subarray(begin, begin + size);
  }
  text(): string {
    return new TextDecoder().decode(this.take(this.u32()));
  }
  words(): Map<string, string> {
    const words = new Map<string, string>();
    for (const entries = new Fields(this.take(this.u32())); entries.left > 0;) {
      words.set(entries.text(), entries.text());
    }
    return words;
  }
  /** Skips to a multiple of a size, as CDR has it behind its first four bytes. */
  align(size: number): void {
    this.move((size - ((this.at - 4) % size)) % size);
  }

  private move(size: number): number {
    if (size > this.left) throw new RangeError("The recording is damaged: a record is cut short.");
    const begin = this.at;
    this.at += size;
    return begin;
  }
}

/** Bytes of a file that is read from its begin to its end, large pieces skipped. */
class Window {
  private bytes = new Uint8Array(0);
  private begin = 0;

  constructor(private readonly file: Blob) {}

  async take(at: number, size: number): Promise<Uint8Array<ArrayBuffer>> {
    if (at < this.begin || at + size > this.begin + this.bytes.length) {
      const end = at + Math.max(size, windowBytes);
      this.bytes = new Uint8Array(await this.file.slice(at, end).arrayBuffer());
      this.begin = at;
    }
    return this.bytes.subarray(at - this.begin, at - this.begin + size);
  }
}

/** A stream, and what reads its messages. */
interface Stream {
  readonly track: Track;
  readonly places: { readonly chunks: Column; readonly offsets: Column; readonly besides: Column };
}

interface Channel {
  /** Of messages of MTP: the stream's name; of those beside them: the topic of these. */
  readonly stream?: string;
  readonly beside?: string;
  readonly topic: string;
}

class McapFile {
  private readonly channels = new Map<number, Channel>();
  private readonly streams = new Map<string, Stream>(); // by topic
  private readonly chunks = new Column(); // where they are
  private newest?: { readonly at: number; readonly bytes: Promise<Uint8Array<ArrayBuffer>> };

  constructor(private readonly file: Blob) {}

  /** Looks at all records, up to the last whole one. */
  async index(progress: (part: number) => void): Promise<Track[]> {
    const window = new Window(this.file);
    const begin = await window.take(0, magic.length);
    if (!magic.every((byte, i) => byte === begin[i])) throw new Error("This is no MCAP file.");
    let indexes: Uint8Array<ArrayBuffer>[] | undefined; // of the last chunk
    let isWhole = false;
    const finish = async () => {
      if (indexes) this.addChunk(indexes.length > 0 ? indexes : await this.indexesOf());
      indexes = undefined;
    };
    for (let at = magic.length; at + recordHead <= this.file.size;) {
      const head = new Fields(await window.take(at, recordHead));
      const [opcode, length] = [head.u8(), head.length()];
      const content = at + recordHead;
      isWhole = opcode === opcodes.dataEnd;
      if (isWhole || content + length > this.file.size) break;
      if (opcode === opcodes.messageIndex) {
        indexes?.push((await window.take(content, length)).slice());
      } else {
        await finish();
      }
      if (opcode === opcodes.channel) this.addChannel(await window.take(content, length));
      if (opcode === opcodes.chunk) {
        this.chunks.push(at);
        indexes = [];
      }
      at = content + length;
      progress(at / this.file.size);
    }
    if (indexes && !isWhole) indexes = []; // some of them may be missing
    await finish();
    return [...this.streams.values()].map(({ track }) => track);
  }

  private addChannel(content: Uint8Array<ArrayBuffer>): void {
    const fields = new Fields(content);
    const id = fields.u16();
    fields.u16();
    const topic = fields.text();
    fields.text();
    const words = fields.words();
    const stream = words.get("hypercolumn.stream");
    this.channels.set(id, { topic, stream, beside: words.get("hypercolumn.mtp") });
    if (stream === undefined || this.streams.has(topic)) return;
    const places = { chunks: new Column(), offsets: new Column(), besides: new Column() };
    const track = new Track(stream, (index) =>
      this.message(
        places.chunks.at(index),
        places.offsets.at(index),
        places.besides.at(index),
        topic,
      ),
    );
    this.streams.set(topic, { track, places });
  }

  /** The indexes of the last chunk, out of its contents: it has none. */
  private async indexesOf(): Promise<Uint8Array<ArrayBuffer>[]> {
    const bytes = await this.chunk(this.chunks.length - 1);
    const indexes: Uint8Array<ArrayBuffer>[] = [];
    for (let at = 0; at < bytes.length;) {
      const record = new Fields(bytes.subarray(at));
      const opcode = record.u8();
      const content = record.take(record.length());
      if (opcode === opcodes.channel) this.addChannel(content);
      if (opcode === opcodes.message) {
        const index = new DataView(new ArrayBuffer(22));
        index.setUint16(0, new Fields(content).u16(), true);
        index.setUint32(2, 16, true);
        index.setBigUint64(
          6,
          new DataView(content.slice(6, 14).buffer).getBigUint64(0, true),
          true,
        );
        index.setBigUint64(14, BigInt(at), true);
        indexes.push(new Uint8Array(index.buffer));
      }
      at = bytes.length - record.left;
    }
    return indexes;
  }

  /** Adds the messages of the last chunk. */
  private addChunk(indexes: readonly Uint8Array<ArrayBuffer>[]): void {
    const entries: { time: number; offset: number; channel: Channel | undefined }[] = [];
    for (const index of indexes) {
      const fields = new Fields(index);
      const channel = this.channels.get(fields.u16());
      for (const list = new Fields(fields.take(fields.u32())); list.left > 0;) {
        entries.push({ time: list.time(), offset: list.length(), channel });
      }
    }
    entries.sort((a, b) => a.offset - b.offset);
    const besides = new Map<string, number>(); // the last offset, by topic of MTP
    entries.forEach(({ time, offset, channel }, i) => {
      if (channel?.beside !== undefined) besides.set(channel.beside, offset);
      const stream = this.streams.get(channel?.topic ?? "");
      if (channel?.stream === undefined || !stream) return;
      const beside = besides.get(channel.topic) ?? -1;
      const next = entries[i + 1]?.offset ?? offset;
      stream.places.chunks.push(this.chunks.length - 1);
      stream.places.offsets.push(offset);
      stream.places.besides.push(beside);
      stream.track.add(time, next - (beside < 0 ? offset : beside));
    });
  }

  /** The messages of a chunk, plain. */
  private chunk(number: number): Promise<Uint8Array<ArrayBuffer>> {
    const at = this.chunks.at(number);
    if (this.newest?.at !== at) this.newest = { at, bytes: this.readChunk(at) };
    return this.newest.bytes;
  }

  private async readChunk(at: number): Promise<Uint8Array<ArrayBuffer>> {
    const read = async (begin: number, size: number) =>
      new Uint8Array(await this.file.slice(begin, begin + size).arrayBuffer());
    const length = new Fields((await read(at, recordHead)).subarray(1)).length();
    const fields = new Fields(await read(at + recordHead, length));
    fields.take(16);
    const size = fields.length();
    fields.u32(); // the CRC
    const compression = fields.text();
    const stored = fields.take(fields.length());
    if (size > mostBytes) throw new Error("A chunk of this recording is too large for the page.");
    if (compression === "") return stored;
    if (compression === "zstd") return expandZstd(stored, size);
    throw new Error(`This recording is compressed by ${compression}, which is not known here.`);
  }

  private async message(
    number: number,
    offset: number,
    beside: number,
    topic: string,
  ): Promise<Message> {
    const chunk = await this.chunk(number);
    const record = (at: number) => {
      const fields = new Fields(chunk.subarray(at));
      fields.u8();
      const content = new Fields(fields.take(fields.length()));
      content.u16();
      const sequence = content.u32();
      content.take(16);
      return { sequence, data: content.take(content.left) };
    };
    const { sequence, data } = record(offset);
    // hypercolumn_msgs/msg/Matrix in CDR.
    const matrix = new Fields(data);
    matrix.take(4);
    const line = matrix.text().replace(/\0$/, "");
    matrix.align(4);
    const [from, size] = [matrix.u32(), matrix.u32()];
    let bytes = matrix.take(matrix.u32());
    if (from > 0) {
      const other = beside < 0 ? undefined : record(beside);
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
 * The streams of a file of MCAP. One that is cut off has what is whole.
 *
 * @param progress  called with the part that has been read, 0 … 1.
 * Errors: it is no such file, or damaged.
 */
export function openMcap(
  file: Blob,
  progress: (part: number) => void = () => {},
): Promise<Track[]> {
  return new McapFile(file).index(progress);
}
