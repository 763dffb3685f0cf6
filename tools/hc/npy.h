// SPDX-License-Identifier: Apache-2.0
#pragma once
// Converts NumPy's .npy files to messages.
// Source: numpy.lib.format, versions 1.0 to 3.0 of the format.

#include <span>

#include <hc/mtp/message.h>

namespace tool {

/// Parses a file: an array of up to three dimensions, (height, width, components), in C order and
/// little-endian, of one of MTP's scalars or bool. Three components of u8 become an RGB image,
/// everything else a table.
///
/// Errors: Malformed, Unsupported (another type, byte order or more dimensions).
hc::Result<hc::Message> read_npy(std::span<const std::byte> bytes);

}  // namespace tool
