// SPDX-License-Identifier: Apache-2.0

/** A malformed message: the violated rule of spec/mtp-1.md, and the position. */
export class MtpError extends Error {
  /**
   * @param rule  "R1" … "R45".
   * @param field  name of a header field, or header, elements, length, stream.
   * @param byte  offset from the start of the stream.
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
