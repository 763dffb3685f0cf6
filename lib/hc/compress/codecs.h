// SPDX-License-Identifier: Apache-2.0
#pragma once
// The two codecs behind compress(), each a file over its library; a build without the library has
// no_zstd.cpp or no_jpeg.cpp in its place. Internal to compress.

#include <hc/base/result.h>
#include <hc/mtp/message.h>

namespace hc::internal {

/// The message with its elements expanded. `message` is compressed in that encoding.
///
/// Errors: Malformed (R36, R37), TooLarge (R36), Unsupported (this build lacks the library).
/// Cost: no more memory than the header promises and, for a JPEG image, a few rows; six times that
/// for a progressive one.
Result<Message> expand_zstd(const Message& message);
Result<Message> expand_jpeg(const Message& message);

/// The message compressed. `message` is plain, and of a kind that the encoding is for (R21).
///
/// Errors: Unsupported (this build lacks the library).
Result<Message> compress_zstd(const Message& message);
Result<Message> compress_jpeg(const Message& message, int quality);

/// "R36 elements: …, at byte N"
Error damaged(int rule, std::string_view what, const Message& message);
/// The same for a promise that the compressed bytes cannot keep.
Error too_few_bytes(int rule, const Message& message);
/// The error of a build without a library.
Error no_codec(std::string_view encoding, std::string_view package);
/// A message with the header of `message` and plain elements.
Message plain_message(const Message& message, const SharedBytes& bytes);

}  // namespace hc::internal
