// SPDX-License-Identifier: Apache-2.0
#pragma once
// A message as one line of JSON (spec/mtp-1.md, section 8).

#include <functional>
#include <string_view>

#include <hc/mtp/message.h>

namespace tool {

/// Writes the JSON form and a line end piece by piece, of some 64 KiB. Compressed elements become
/// null: expand first.
///
/// @param header  written in place of the message's: that with which compressed elements came.
/// @param write  takes a piece; false ends it.
/// @returns  whether all was taken.
bool write_json(const hc::Message& message, const hc::Header& header,
                const std::function<bool(std::string_view piece)>& write);

}  // namespace tool
