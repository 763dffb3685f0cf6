// SPDX-License-Identifier: Apache-2.0
#pragma once
// JPEG pictures of u8 images by libjpeg-turbo. Internal to compress.

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include <hc/mtp/message.h>

namespace hc::internal {

/// Reads one picture of just the header's width, height and components into `pixels`, (height,
/// width, components) u8. Gives what is wrong with the bytes, or nothing. Memory stays within what
/// the header promises and a few rows, for a progressive picture within six times that.
std::optional<std::string> read_jpeg(std::span<const std::byte> bytes, const Header& header,
                                     std::byte* pixels);

/// The message, a plain picture that JPEG can hold, with a JPEG picture for its elements.
Message write_jpeg(const Message& message, int quality);

}  // namespace hc::internal
