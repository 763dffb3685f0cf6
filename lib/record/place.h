// SPDX-License-Identifier: Apache-2.0
#pragma once
// Interprets a word of the command line: a link, or a recording in one of three formats. The same
// for all verbs (doc/recordings.md, "Names").

#include <string>
#include <string_view>

#include <hc/base/uri.h>

namespace hc::record {

struct Place {
  enum class Kind {
    Link,    ///< `uri`
    File,    ///< a file of messages of MTP
    Folder,  ///< with a file STREAM.mtp per stream
    Mcap,    ///< an MCAP file
  };
  Kind kind = Kind::File;
  std::string path;    ///< of a recording
  std::string stream;  ///< the only one to read; empty: all
  Uri uri;             ///< of a link or file

  /// As written on the command line.
  [[nodiscard]] std::string text() const;
  /// The name of its stream: "MODULE.PORT", or the file name without folder and extension.
  [[nodiscard]] std::string name() const;
};

/// `-` and words that begin with a scheme, such as `tcp:`, are links; all others are paths, with
/// any characters. A path is MCAP if it is_mcap_path(), and a folder if it is one or ends in "/";
/// both may have `?stream=NAME` appended.
///
/// Errors: Invalid (a link with a part that it cannot have, or the empty word).
Result<Place> place_of(std::string_view word);

/// As place_of(), for a recording of several streams: anything but MCAP is a folder.
/// Errors: Invalid (a link, or the empty word).
Result<Place> place_of_streams(std::string_view word);

/// This place, or the first one of PATH_2, PATH_3, … without a recording.
/// @param is_numbered  for numbered files, which are always free.
Place free_place(Place place, bool is_numbered = false);

/// FOLDER/STREAM.mtp
std::string stream_file(const std::string& folder, const std::string& stream);

}  // namespace hc::record
