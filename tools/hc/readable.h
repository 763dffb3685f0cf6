// SPDX-License-Identifier: Apache-2.0
#pragma once
// A message for a person's eyes.

#include <string>
#include <string_view>

#include <hc/mtp/message.h>

namespace tool {

/// A line that says what the message is, and its elements below it: all of a small one, the corner
/// and the range of a large one.
std::string to_readable(const hc::Message& message);

/// "2025-11-21 04:20:00.123456789", in UTC.
std::string time_in_words(std::int64_t time);

}  // namespace tool
