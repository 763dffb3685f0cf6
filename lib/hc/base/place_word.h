// SPDX-License-Identifier: Apache-2.0
#pragma once
// Words of command lines that name a link or a file, the same for all programs
// (doc/recordings.md, "Names").

#include <string_view>

#include <hc/base/result.h>
#include <hc/base/uri.h>

namespace hc {

/// The link that a word names if it is `-` or begins with a scheme, such as `tcp:`; else the file
/// with this path, which may have any characters: "2025-11-25T13:00:00.mtp", or "odd?name" if that
/// file exists.
///
/// Errors: as parse_uri(), for words that begin with a scheme and for the empty one.
Result<Uri> parse_place_word(std::string_view word);

/// Whether a path is that of a recording in MCAP: it ends in ".mcap", in letters of either case.
bool is_mcap_path(std::string_view path);

}  // namespace hc
