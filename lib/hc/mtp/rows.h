// SPDX-License-Identifier: Apache-2.0
#pragma once
// Lines of text as one message: a string with a row for each. Pure.

#include <span>
#include <string>
#include <vector>

#include <hc/mtp/message.h>

namespace hc {

/// A string with a row for each of `lines`, filled up with spaces to the longest of them; empty
/// where there is none.
Message make_rows(std::span<const std::string> lines);

/// The rows of a string, without the spaces at their ends; nothing of what is no string.
std::vector<std::string> rows_of(const Message& message);

}  // namespace hc
