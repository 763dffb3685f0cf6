// SPDX-License-Identifier: Apache-2.0
#pragma once
// The codecs behind compress(), one file per library; builds without the library use no_zstd.cpp or
// no_jpeg.cpp instead. Internal to compress.

#include <hc/base/result.h>
#include <hc/mtp/message.h>

namespace hc::internal {

/// Decompresses the elements. `message` is compressed with this codec.
///
/// Errors: Malformed (R36, R37), TooLarge (R36), Unsupported (this build lacks the library).
/// Cost: allocates the size in the header; for a JPEG image also a few rows, and six times its size
/// if it is progressive.
Result<Message> expand_zstd(const Message& message);
Result<Message> expand_jpeg(const Message& message);

/// Compresses the elements. `message` is plain and of a type that the encoding supports (R21).
///
/// Errors: Unsupported (this build lacks the library).
Result<Message> compress_zstd(const Message& message);
Result<Message> compress_jpeg(const Message& message, int quality);

/// "R36 elements: …, at byte N"
Error damaged(int rule, std::string_view what, const Message& message);
/// damaged(), for a header whose size the compressed bytes cannot expand to.
Error too_few_bytes(int rule, const Message& message);
/// The error of a build without a library.
Error no_codec(std::string_view encoding, std::string_view package);
/// A message with the header of `message` and plain elements.
Message plain_message(const Message& message, const SharedBytes& bytes);

}  // namespace hc::internal
