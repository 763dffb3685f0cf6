// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a word on the command line names: a link, or a recording in one of three formats. All verbs
// share this rule (doc/recordings.md, "Names").

#include <string>
#include <string_view>

#include <hc/base/uri.h>

namespace hc::record {

struct Place {
  enum class Kind {
    Link,    ///< `uri`
    File,    ///< a file of messages of MTP
    Folder,  ///< with a file STREAM.mtp for each stream
    Mcap,    ///< an MCAP file
  };
  Kind kind = Kind::File;
  std::string path;    ///< of a recording
  std::string stream;  ///< to be read alone; empty: all
  Uri uri;             ///< of a link or file

  /// As it is written on the command line.
  [[nodiscard]] std::string text() const;
  /// The name for its stream: "MODULE.PORT", or that of the file without folder and ending.
  [[nodiscard]] std::string name() const;
};

/// `-` and words that begin with a scheme, `tcp:`, are links; all others are paths, with any
/// letters. A path is MCAP if it ends in ".mcap", and a folder if it is one or ends in "/"; both
/// may have `?stream=NAME` appended.
Place place_of(std::string_view word);

/// The same for a recording of several streams: what is not MCAP is a folder.
Place place_of_streams(std::string_view word);

/// This place, or the first of PATH_2, PATH_3, … without a recording.
/// @param is_numbered  it names numbered files, and so is always free.
Place free_place(Place place, bool is_numbered = false);

/// FOLDER/STREAM.mtp
std::string stream_file(const std::string& folder, const std::string& stream);

}  // namespace hc::record
