// SPDX-License-Identifier: Apache-2.0

/** A message that a reader refuses: which rule of spec/mtp-1.md it breaks, and where. */
export class MtpError extends Error {
  /**
   * @param rule  "R1" … "R45".
   * @param field  name of a header field, or header, elements, length, stream.
   * @param byte  distance from the start of the stream, the first byte being 0.
   */
  constructor(
    readonly rule: string,
    readonly field: string,
    readonly byte: number,
    why = "",
  ) {
    super(`${rule} ${field}, byte ${byte}${why && ": " + why}`);
    this.name = "MtpError";
  }
}
