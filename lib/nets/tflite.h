// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads networks from the bytes of TensorFlow Lite's files. Pure.
// Source: tensorflow/lite/schema/schema.fbs, version 3; FlatBuffers' binary format.

#include <cstddef>
#include <span>

#include <hc/base/result.h>
#include <nets/layers.h>

namespace hc::nets {

/// The layers of a file with one graph, one input, and weights of 16 or 32 bits. Of any bytes: no
/// read outside of them.
///
/// Errors: Malformed (not such a file, or inconsistent), Unsupported (an operator, a type),
/// TooLarge (more than kMostNumbers constants and results).
/// Cost: linear in the bytes; allocates 4 bytes for each weight.
Result<Layers> read_tflite(std::span<const std::byte> bytes);

}  // namespace hc::nets
