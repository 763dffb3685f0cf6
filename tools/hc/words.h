// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a word of the command line means: a link, a port of a running graph, or a file; the same in
// all verbs (doc/recordings.md, "Names").

#include <memory>
#include <optional>
#include <string>

#include <hc/contract/running_graph.h>
#include <record/place.h>

#include "common.h"

namespace tool {

/// Whether a word ends like the file of a recording: `.mtp` or `.mcap`.
bool is_recording_file(const std::string& word);

/// The running graph of which a word is a port; nullopt for a link or a file. Fails if the word is
/// neither a port nor a file, and if it is a port of one of several graphs.
///
/// @param of  name of the running graph; empty: as choose_running().
std::optional<hc::RunningGraph> graph_of_port(const std::string& word, const std::string& of);

/// Where to read from. The port of a running graph is a link, which does not end with the graph.
hc::record::Place place_of(const std::string& word, const std::string& of);

/// Opens what to read from. The port of a running graph ends with it.
std::unique_ptr<hc::Source> open_named(const std::string& word, const std::string& of,
                                       std::uint64_t limit);

/// Fails if a place to write to is a port of a running graph: only `hc send --to` writes there.
void check_output(const std::string& word);
/// Opens what to write to.
std::unique_ptr<hc::Sink> open_output(const std::string& word);

/// An end of a link for a running graph. A path, which has a `/` or ends as recordings do, becomes
/// a URI with its absolute path, since the graph may run in another folder.
std::string link_end(const std::string& word);

}  // namespace tool
