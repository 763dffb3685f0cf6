// SPDX-License-Identifier: Apache-2.0
#pragma once
// Lines of text as a message: a string with one row per line. Pure.

#include <span>
#include <string>
#include <vector>

#include <hc/mtp/message.h>

namespace hc {

/// A string with a row for each of `lines`, padded with spaces to the longest; empty without lines.
Message make_rows(std::span<const std::string> lines);

/// The rows of a string without trailing spaces; empty if the message is not a plain string.
std::vector<std::string> rows_of(const Message& message);

}  // namespace hc
