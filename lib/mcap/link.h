// SPDX-License-Identifier: Apache-2.0
#pragma once
// Recordings in MCAP as links, so that they go wherever a file of messages goes:
// `kept.mcap`, and `kept.mcap?stream=head_eyes.left` for one of its streams.

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/uri.h>
#include <hc/link/link.h>
#include <mcap/reader.h>

namespace hc::mcap {

/// The URI of a recording in MCAP: a file whose name ends in ".mcap". Nothing for all others.
std::optional<Uri> recording_uri(std::string_view text);

/// A stream of a recording.
struct StreamInfo {
  std::string name;                 ///< "head_eyes.left"
  std::string topic, type;          ///< of its messages of ROS 2; empty: it has none
  std::vector<std::string> topics;  ///< all that it has, with that of MTP
  std::uint64_t messages = 0;
};
/// The streams of a recording, by name.
std::vector<StreamInfo> streams(const Summary& summary);

/// The messages of a recording, or of one of its streams, in the order in which they were recorded.
/// resume() continues behind what is damaged.
///
/// Errors: Invalid (an option that it does not have), NotFound (no such file or stream), Malformed,
/// Unsupported (no messages of MTP in it), System.
Result<std::unique_ptr<Source>> read_recording(const Uri& uri, const LinkOptions& options = {});

/// The stream of the message that such a source gave last; empty: it is another source, or has
/// given none.
std::string_view stream_of(const Source& source);

/// A recording that is made of what is sent; a stream for each src. Errors: Invalid, System.
Result<std::unique_ptr<Sink>> write_recording(const Uri& uri, const LinkOptions& options = {});

}  // namespace hc::mcap
