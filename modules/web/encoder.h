// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages as a page wants them: scaled down, JPEG, VP8 (spec/page.md, W9).

#include <memory>
#include <string>

#include <hc/base/result.h>
#include <hc/mtp/message.h>

enum class Form { Raw, Jpeg, Vp8 };

/// Whether a message is an image that JPEG and VP8 can hold: colour or grey, of u8.
bool is_picture(const hc::Header& header);

/// A message of an image, a vector field or a map with at most `width` elements in a row: images of
/// u8 by area, others by every n-th element. All other messages, and with width 0, as they are.
///
/// Errors: Unsupported (OpenCV has no matrix of its scalar).
hc::Result<hc::Message> scaled(const hc::Message& message, int width);

/// Encodes images of one stream as VP8 (RFC 6386), for one frame at a time without delay.
class Vp8Encoder {
 public:
  Vp8Encoder();
  ~Vp8Encoder();
  Vp8Encoder(const Vp8Encoder&) = delete;
  Vp8Encoder& operator=(const Vp8Encoder&) = delete;

  /// @param message  where is_picture(). An odd last column or row is cut off.
  /// @param is_key  encode a key frame; the first one, and one of another size, always is.
  /// @returns  a table of u8, 1 × N, the frame's bytes, with the header's src, seq, time, mode,
  /// coord. Errors: Unsupported (less than 2 × 2), System.
  hc::Result<hc::Message> encode(const hc::Message& message, bool is_key);

 private:
  struct Codec;
  std::unique_ptr<Codec> codec_;
};

/// Whether a VP8 frame can be shown without those before it.
bool is_key_frame(const hc::Message& vp8);
