// SPDX-License-Identifier: Apache-2.0
import type { Message } from "./message";

/** The bytes of a message in canonical form (R38). */
export function writeMessage(message: Message): Uint8Array<ArrayBuffer> {
  throw new Error(`not written yet: ${message.header.type}`);
}
