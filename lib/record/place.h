// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a word names: a link, or a recording and how it is written. The one rule of all verbs
// (doc/recordings.md, "Names").

#include <string>
#include <string_view>

#include <hc/base/uri.h>

namespace hc::record {

struct Place {
  enum class Kind {
    Link,    ///< `uri`
    File,    ///< messages of MTP, one stream behind the other
    Folder,  ///< a file STREAM.mtp for each stream
    Mcap,    ///< one file of MCAP
  };
  Kind kind = Kind::File;
  std::string path;    ///< of all but a link
  std::string stream;  ///< the only one that is read; empty: all
  Uri uri;             ///< of a link, and of a file

  /// As a person would write it.
  [[nodiscard]] std::string text() const;
};

/// `-` and what begins with the name of a transport, `tcp:`, is a link; all else a path, with any
/// letters. A path that ends in ".mcap" is a file of MCAP, and a folder one that is there or ends
/// in
/// "/". Behind both may stand `?stream=NAME`.
Place place_of(std::string_view word);

/// A place for a recording of several streams, as place_of(), but that everything other than MCAP
/// is a folder.
Place place_of_streams(std::string_view word);

/// The first free place for a recording of a graph: this one, or PATH_2 beside it, and so on.
/// @param is_numbered  its files have numbers, so it is free in any case.
Place free_place(Place place, bool is_numbered = false);

/// FOLDER/STREAM.mtp
std::string stream_file(const std::string& folder, const std::string& stream);

}  // namespace hc::record
