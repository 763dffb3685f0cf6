// SPDX-License-Identifier: Apache-2.0
// Reads messages from bytes (spec/mtp-1.md).
import { bytesOf, elementsOf, zeros } from "./elements";
import { MtpError } from "./error";
import { maxHeaderBytes, parseHeader } from "./header";
import { scalarBytes } from "./info";
import { scalarCount, type Elements, type Header, type Message } from "./message";
import { isInteger, numberOf } from "./number";

const LF = 0x0a;
const CR = 0x0d;
const space = 0x20;
const maxNumberBytes = 64;
const maxLengthLine = 20;

/** The position of a reader within a message. */
type Place =
  | { readonly at: "header" }
  | {
      readonly at: "numbers";
      readonly header: Header;
      elements: Elements;
      read: number;
      rows: number;
    }
  | { readonly at: "length"; readonly header: Header }
  | { readonly at: "bytes"; readonly header: Header; readonly count: number }
  | { readonly at: "close"; readonly header: Header; readonly elements: Elements };

/**
 * Reads a stream piece by piece. A basic reader: zstd and jpeg elements stay compressed.
 *
 *     const reader = new Reader();
 *     for await (const piece of pieces) {
 *       reader.push(piece);
 *       for (let message; (message = reader.next()); ) use(message);
 *     }
 *     reader.end();
 */
export class Reader {
  private buffer: Uint8Array<ArrayBuffer> = new Uint8Array(0);
  private owned = false; // the reader may write to the buffer
  private from = 0; // first unused byte in the buffer
  private to = 0; // end of the bytes in the buffer
  private before = 0; // bytes of the stream before the buffer
  private scanned = 0; // bytes after `from` without a line feed
  private place: Place = { at: "header" };

  /** @param limit  maximum bytes of a message's elements (R24). */
  constructor(private readonly limit = 256 * 2 ** 20) {}

  /** Adds bytes, which must not change afterwards, since elements may be views of them. */
  push(bytes: Uint8Array<ArrayBuffer>): void {
    if (this.from === this.to) {
      this.before += this.from;
      this.buffer = bytes;
      this.owned = false;
      this.from = 0;
      this.to = bytes.length;
      return;
    }
    const size = this.to - this.from + bytes.length;
    if (!this.owned || this.to + bytes.length > this.buffer.length) {
      // A new buffer, since messages may be views of the old one.
      const grown = new Uint8Array(Math.max(2 * size, 256));
      grown.set(this.buffer.subarray(this.from, this.to));
      this.before += this.from;
      this.to -= this.from;
      this.from = 0;
      this.buffer = grown;
      this.owned = true;
    }
    this.buffer.set(bytes, this.to);
    this.to += bytes.length;
  }

  /** Offset of the next message, or of its next part, in the stream. */
  get byte(): number {
    return this.before + this.from;
  }

  /** The next message; undefined while incomplete. Errors: MtpError, which ends the reader. */
  next(): Message | undefined {
    for (;;) {
      const place = this.place;
      switch (place.at) {
        case "header": {
          const header = this.header();
          if (!header) return undefined;
          this.place = this.elementsPlace(header);
          break;
        }
        case "numbers":
          if (!this.numbers(place)) return undefined;
          this.place = { at: "header" };
          return { header: place.header, elements: place.elements };
        case "length": {
          const count = this.compressedBytes();
          if (count === undefined) return undefined;
          this.place = { at: "bytes", header: place.header, count };
          break;
        }
        case "bytes": {
          if (this.to - this.from < place.count) return undefined;
          const bytes = this.buffer.subarray(this.from, this.from + place.count);
          this.from += place.count;
          const { encoding, scalar } = place.header;
          const isCompressed = encoding === "zstd" || encoding === "jpeg";
          const elements = isCompressed ? bytes : elementsOf(scalar, bytes);
          this.place = { at: "close", header: place.header, elements };
          break;
        }
        case "close":
          if (!this.close(place.header.encoding === "text")) return undefined;
          this.place = { at: "header" };
          return { header: place.header, elements: place.elements };
      }
    }
  }

  /** Ends the stream. Errors: MtpError R2 if a message is incomplete. */
  end(): void {
    if (this.place.at !== "header" || this.from < this.to) {
      throw new MtpError("R2", "stream", this.before + this.to, "the stream ends inside a message");
    }
  }

  private refuse(rule: string, field: string, at: number, why = ""): never {
    throw new MtpError(rule, field, this.before + at, why);
  }

  private text(from: number, to: number): string {
    let text = "";
    for (let i = from; i < to; ++i) text += String.fromCharCode(this.buffer[i]!);
    return text;
  }

  /** Index of the first line feed within `most` bytes; -1: none yet. */
  private lineFeed(most: number): number {
    const end = Math.min(this.to, this.from + most);
    for (let i = this.from + this.scanned; i < end; ++i) {
      if (this.buffer[i] === LF) {
        this.scanned = 0;
        return i;
      }
    }
    this.scanned = end - this.from;
    return -1;
  }

  private header(): Header | undefined {
    const end = this.lineFeed(maxHeaderBytes);
    if (end < 0) {
      if (this.scanned < maxHeaderBytes) return undefined;
      this.refuse("R3", "header", this.from + maxHeaderBytes, "the line is too long");
    }
    const last = end > this.from && this.buffer[end - 1] === CR ? end - 1 : end;
    const header = parseHeader(this.text(this.from, last), this.before + this.from, this.limit);
    this.from = end + 1;
    return header;
  }

  private elementsPlace(header: Header): Place {
    if (header.encoding === "zstd" || header.encoding === "jpeg") return { at: "length", header };
    const count = scalarCount(header);
    if (count === 0) return { at: "close", header, elements: zeros(header.scalar, 0) };
    if (header.encoding === "text" && header.type !== "string") {
      // Grown as data arrives: a number and its separator take at least two bytes.
      const elements = zeros(header.scalar, Math.min(count, 4096));
      return { at: "numbers", header, elements, read: 0, rows: 0 };
    }
    return { at: "bytes", header, count: count * scalarBytes[header.scalar] };
  }

  /** Reads numbers in text; returns whether all rows are complete. */
  private numbers(place: Extract<Place, { at: "numbers" }>): boolean {
    const { header } = place;
    const inRow = header.width * header.components;
    const count = scalarCount(header);
    for (;;) {
      while (this.from < this.to && this.buffer[this.from] === space) ++this.from;
      let end = this.from;
      while (end < this.to && !this.endsNumber(end)) {
        if (++end - this.from > maxNumberBytes) this.refuse("R31", "elements", this.from);
      }
      if (end === this.to || (this.buffer[end] === CR && end + 1 === this.to)) return false;
      const inThisRow = place.read - inRow * place.rows;
      if (end === this.from) {
        // Line end.
        if (inThisRow < inRow) this.refuse("R29", "elements", this.from);
        this.from += this.buffer[this.from] === CR ? 2 : 1;
        place.rows += 1;
        if (place.rows === header.height) return true;
        continue;
      }
      if (inThisRow === inRow) this.refuse("R30", "elements", this.from);
      const value = numberOf(this.text(this.from, end), header.scalar);
      if (typeof value === "string") this.refuse(value, "elements", this.from);
      if (place.read === place.elements.length)
        place.elements = grown(place.elements, header, count);
      place.elements[place.read++] = value;
      this.from = end;
    }
  }

  /** Whether a space or line end is at an index; a CR at the end of the buffer counts. */
  private endsNumber(index: number): boolean {
    const byte = this.buffer[index];
    if (byte === CR) return index + 1 === this.to || this.buffer[index + 1] === LF;
    return byte === space || byte === LF;
  }

  private compressedBytes(): number | undefined {
    const end = this.lineFeed(maxLengthLine + 1);
    if (end < 0 && this.scanned <= maxLengthLine) return undefined;
    const text = end < 0 ? "" : this.text(this.from, end);
    if (!isInteger(text) || text.startsWith("-")) this.refuse("R34", "length", this.from);
    if (BigInt(text) > BigInt(this.limit)) this.refuse("R35", "length", this.from);
    this.from = end + 1;
    return Number(text);
  }

  /** Reads the line feed that ends a message; false if it has not arrived. */
  private close(isText: boolean): boolean {
    if (this.from === this.to) return false;
    let at = this.from;
    if (isText && this.buffer[at] === CR) {
      if (++at === this.to) return false;
    }
    if (this.buffer[at] !== LF) this.refuse("R26", "elements", this.from);
    this.from = at + 1;
    return true;
  }
}

/** Elements with twice the capacity, up to the final size. */
function grown(elements: Elements, header: Header, count: number): Elements {
  const larger = zeros(header.scalar, Math.min(count, 2 * elements.length));
  bytesOf(larger).set(bytesOf(elements));
  return larger;
}

/** The single message in `bytes`; its elements may be a view. Errors: MtpError. */
export function readMessage(bytes: Uint8Array<ArrayBuffer>): Message {
  const reader = new Reader();
  reader.push(bytes);
  const message = reader.next();
  if (!message)
    throw new MtpError("R2", "stream", bytes.length, "the stream ends inside a message");
  if (reader.byte < bytes.length) throw new MtpError("R2", "stream", reader.byte, "more than one");
  return message;
}
