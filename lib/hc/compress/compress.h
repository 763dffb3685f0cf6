// SPDX-License-Identifier: Apache-2.0
#pragma once
// The compressed encodings: zstd of the binary form, and JPEG for images (spec/mtp-1.md,
// R34 … R37). Uses libzstd and libjpeg-turbo; stateless, any thread.

#include <cstddef>
#include <span>

#include <hc/base/result.h>
#include <hc/mtp/message.h>

namespace hc {

/// The message with plain elements: itself, or a decompressed copy in binary encoding.
///
/// Errors: Malformed (R36, R37: the bytes are damaged, or do not match the header); TooLarge (R36:
/// an implausible compression ratio); Unsupported (this build lacks the codec). The detail names
/// rule and field.
/// Cost: decompression; allocates at most the size in the header.
Result<Message> expand(const Message& message);

/// Default JPEG quality, 1 … 100; from 90 on, colour keeps its full resolution.
inline constexpr int kJpegQuality = 90;

/// The message in another encoding; the inverse of expand(), except for the losses of JPEG.
///
/// Errors: Unsupported (a type that the encoding does not support, R21; a codec that this build
/// lacks); Malformed, as expand(). Cost: compression and one allocation; none if the message has
/// the encoding already.
Result<Message> compress(const Message& message, Encoding encoding,
                         int jpeg_quality = kJpegQuality);

/// Checks the contents of a JPEG file of any kind, which decoders show with grey parts where it is
/// damaged or cut.
///
/// Errors: Malformed; "Premature end of JPEG file". A build without the codec finds none.
/// Cost: about half of its decompression; allocates two bytes a pixel and component.
Status check_jpeg(std::span<const std::byte> file);

}  // namespace hc
