// SPDX-License-Identifier: Apache-2.0
#pragma once
// What is said on the line to a FLIR (Directed Perception) pan-tilt unit, such as the PTU-D46, in
// its ASCII protocol. Pure.
// Source: PTU-D46 Command Reference, version 2.14.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <hc/base/result.h>

namespace hc::pan_tilt {

/// "pp-200 ": a command with its value, or a query, and what ends it.
std::string command(std::string_view name, std::optional<std::int32_t> value = std::nullopt);

/// What a unit says.
struct Reply {
  enum class Kind {
    Done,       ///< `*`: a command was carried out
    Result,     ///< `* 22`: what was asked for, in `text`
    Refused,    ///< `! Maximum allowable Pan position is 3090`: why not, in `text`
    PanLimit,   ///< `!P`: the axis ran into its limit; answers no command
    TiltLimit,  ///< `!T`
  };
  Kind kind = Kind::Done;
  std::string text;  ///< at most kMaxReplyBytes
};

inline constexpr std::size_t kMaxReplyBytes = 128;  ///< of a line; the longest are below 80

/// Takes a unit's bytes as they come, and gives its replies.
///
///     reader.feed(bytes);
///     while (auto reply = reader.next()) {
///       if (!*reply) … (*reply).error();  // garbage; the reader has found its place again
///     }
///
/// Memory: what was fed and not yet taken, and a line of kMaxReplyBytes.
class ReplyReader {
 public:
  void feed(std::string_view bytes);

  /// The next reply, if it is whole. What is no reply is skipped up to the end of its line, and
  /// gives one error, however long it is.
  ///
  /// Errors: Malformed (a byte that begins no reply, or is not printable), TooLarge (a line of more
  /// than kMaxReplyBytes).
  std::optional<Result<Reply>> next();

 private:
  std::optional<Result<Reply>> refuse(Error error);

  std::string bytes_;         // not looked at yet
  std::size_t position_ = 0;  // in them
  std::string line_;          // as much of a reply as has come
  bool skips_ = false;        // garbage, until its line ends
};

/// A number as a unit writes it, all of the text: "22", "-907", "185.1428".
///
/// Errors: Malformed.
Result<double> number(std::string_view text);

}  // namespace hc::pan_tilt
