// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads the face recognition network of face-api: dlib's, with weights of 8 bits. Pure.
// Source: github.com/vladmandic/face-api, src/faceRecognitionNet; dlib's dnn_face_recognition_ex.

#include <cstddef>
#include <span>
#include <string_view>

#include <hc/base/result.h>
#include <nets/layers.h>

namespace hc::nets {

/// The layers: from a face chip of 150 × 150 pixels (RGB, minus a mean face's colour, / 256) to 128
/// numbers, of which those of one person are less than 0.6 apart.
///
/// @param manifest  JSON: the name and shape of each tensor, and the scale and least value of those
/// of bytes.
/// @param weights  the tensors one after the other, of bytes or f32.
///
/// Errors: Malformed, Unsupported (numbers of other types).
/// Cost: allocates 4 bytes for each weight.
Result<Layers> read_face_recognition(std::string_view manifest, std::span<const std::byte> weights);

}  // namespace hc::nets
