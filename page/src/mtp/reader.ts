// SPDX-License-Identifier: Apache-2.0
import type { Message } from "./message";

/** The one message that `bytes` hold. Its elements may be a view of them. Errors: MtpError. */
export function readMessage(bytes: Uint8Array<ArrayBuffer>): Message {
  throw new Error(`not written yet: ${bytes.length}`);
}
