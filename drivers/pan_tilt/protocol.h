// SPDX-License-Identifier: Apache-2.0
#pragma once
// The ASCII protocol of FLIR (Directed Perception) pan-tilt units, such as the PTU-D46. Pure.
// Source: PTU-D46 Command Reference, version 2.14.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <hc/base/result.h>

namespace hc::pan_tilt {

/// A command with its value, or a query, and its delimiter: "pp-200 ".
std::string command(std::string_view name, std::optional<std::int32_t> value = std::nullopt);

/// A reply of the unit.
struct Reply {
  enum class Kind {
    Done,       ///< `*`: command executed
    Result,     ///< `* 22`: the queried value, in `text`
    Refused,    ///< `! Maximum allowable Pan position is 3090`: the reason, in `text`
    PanLimit,   ///< `!P`: the axis ran into its limit; not an answer
    TiltLimit,  ///< `!T`
  };
  Kind kind = Kind::Done;
  std::string text;  ///< at most kMaxReplyBytes
};

inline constexpr std::size_t kMaxReplyBytes = 128;  ///< of a line; units send less than 80

/// Parses a stream of a unit's bytes into replies.
///
///     reader.feed(bytes);
///     while (auto reply = reader.next()) {
///       if (!*reply) … (*reply).error();  // garbage; the reader resynchronises
///     }
///
/// Memory: the bytes fed but not yet taken, and a line of kMaxReplyBytes.
class ReplyReader {
 public:
  void feed(std::string_view bytes);

  /// The next complete reply. An invalid reply is skipped to the end of its line, with one error.
  ///
  /// Errors: Malformed (a byte that does not start a reply, or is not printable), TooLarge (a line
  /// of more than kMaxReplyBytes).
  std::optional<Result<Reply>> next();

 private:
  std::optional<Result<Reply>> refuse(Error error);

  std::string bytes_;         // fed
  std::size_t position_ = 0;  // of the next byte to parse
  std::string line_;          // incomplete reply
  bool skips_ = false;        // skipping garbage to the end of the line
};

/// A number that is the whole text: "22", "-907", "185.1428".
///
/// Errors: Malformed.
Result<double> number(std::string_view text);

}  // namespace hc::pan_tilt
