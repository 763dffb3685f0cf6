// SPDX-License-Identifier: Apache-2.0
#pragma once
// A message as one line of JSON (spec/mtp-1.md, section 8).

#include <string>

#include <hc/mtp/message.h>

namespace tool {

/// The JSON form without a line end. Compressed elements become null: expand first.
std::string to_json(const hc::Message& message);

/// The same with another header than the message's: that with which compressed elements came.
std::string to_json_as(const hc::Message& message, const hc::Header& header);

}  // namespace tool
