// SPDX-License-Identifier: Apache-2.0
#pragma once
// A message as one line of JSON (spec/mtp-1.md, section 8).

#include <functional>
#include <string_view>

#include <hc/mtp/message.h>

namespace tool {

/// Writes the JSON form and a line end, in pieces of about 64 KiB. Compressed elements become null:
/// expand them first.
///
/// @param header  written instead of the message's: the header before expansion.
/// @param write  takes a piece; returns false to stop.
/// @returns  whether all pieces were taken.
bool write_json(const hc::Message& message, const hc::Header& header,
                const std::function<bool(std::string_view piece)>& write);

}  // namespace tool
