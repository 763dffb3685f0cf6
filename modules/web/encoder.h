// SPDX-License-Identifier: Apache-2.0
#pragma once
// Converts messages for a page: scales down, encodes as JPEG or VP8 (spec/page.md, W9).

#include <memory>
#include <string>

#include <hc/base/result.h>
#include <hc/mtp/message.h>

enum class Form { Raw, Jpeg, Vp8 };

/// Whether a message is an image for JPEG and VP8: u8, colour or grey.
bool is_picture(const hc::Header& header);

/// Scales an image, vector field or map to at most `width` elements in a row: u8 images by area,
/// others by every n-th element. Other messages are unchanged, and all with width 0.
///
/// Errors: Unsupported (OpenCV has no such scalar).
hc::Result<hc::Message> scaled(const hc::Message& message, int width);

/// Encodes the images of one stream as VP8 (RFC 6386), frame by frame without delay.
class Vp8Encoder {
 public:
  Vp8Encoder();
  ~Vp8Encoder();
  Vp8Encoder(const Vp8Encoder&) = delete;
  Vp8Encoder& operator=(const Vp8Encoder&) = delete;

  /// @param message  is_picture(). An odd last column or row is cut off.
  /// @param is_key  encode a key frame; the first frame, and the first of a new size, always is.
  /// @returns  a table 1 × N of u8, the frame's bytes, with the image's src, seq, time, mode,
  /// coord. Errors: Unsupported (less than 2 × 2), System.
  hc::Result<hc::Message> encode(const hc::Message& message, bool is_key);

 private:
  struct Codec;
  std::unique_ptr<Codec> codec_;
};

/// Whether a VP8 frame can be decoded without earlier frames.
bool is_key_frame(const hc::Message& vp8);
