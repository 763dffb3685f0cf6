// SPDX-License-Identifier: Apache-2.0
#pragma once
// The compressed encodings: zstd of the binary form, and JPEG of images (spec/mtp-1.md,
// R34 … R37). Uses libzstd and libjpeg-turbo; no state between calls, any thread.

#include <hc/base/result.h>
#include <hc/mtp/message.h>

namespace hc {

/// The message with its elements in binary form: itself when it is plain, else decompressed, with
/// encoding binary.
///
/// Errors: Malformed (R36, R37: the bytes are damaged, or hold less, more or another image than
/// the header says); TooLarge (R36: far more than has come); Unsupported (this build lacks the
/// codec). The detail names rule and field.
/// Cost: decompression; allocates what the header promises, and no more whatever the bytes hold.
Result<Message> expand(const Message& message);

/// Of JPEG, unless another is given: 1 … 100; from 90 on, colour keeps its full resolution.
inline constexpr int kJpegQuality = 90;

/// The message in another encoding; the inverse of expand(), but for what JPEG loses.
///
/// Errors: Unsupported (a type that the encoding cannot hold, R21; a codec that this build lacks);
/// Malformed, as expand(). Cost: compression and one allocation; nothing when the encoding is the
/// message's own already.
Result<Message> compress(const Message& message, Encoding encoding,
                         int jpeg_quality = kJpegQuality);

}  // namespace hc
