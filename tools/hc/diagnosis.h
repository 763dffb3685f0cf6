// SPDX-License-Identifier: Apache-2.0
#pragma once
// From facts, and from what a graph needs, to the lines of `hc doctor`. Pure.

#include <string>
#include <string_view>
#include <vector>

#include <graph/plan.h>

#include "facts.h"

namespace tool {

enum class Mark {
  Ok,
  Missing,  ///< hc, or the graph, needs it
  Wrong,    ///< in the graph file
  Note,     ///< informational
};

struct Finding {
  Mark mark = Mark::Ok;
  std::string what;  ///< "camera", or a module of the graph
  std::string text;
};

/// A path that a run opens.
struct NeededPath {
  std::string module, what;  ///< "parameter source"
  std::string path;          ///< of the file or device; of the folder where it is to be written
  bool is_written = false;
};

/// A TCP port where a run listens.
struct NeededPort {
  std::string module, uri;
  std::string port;  ///< [HOST:]PORT
};

/// The resources that a graph needs.
struct Needs {
  std::size_t modules = 0;
  std::vector<std::string> viewers;  ///< modules `view` that do not save
  std::vector<NeededPath> paths;
  std::vector<NeededPort> ports;
};

/// What of a plan is to be looked for on this machine: ports where its links listen, files of its
/// links, and parameters that name a file or a device (see path_of_parameter).
Needs needs_of(const hc::Plan& plan);

/// Whether a parameter names a path, and which. It does
///
/// - where the value begins with /dev/ or a word of its name is source, file, path, folder,
///   directory, device, model or config: what is read must be there;
/// - where a word of its name is save, output, log or record: the folder must be there;
///
/// and the value begins with / or ./ or ../, or holds a /, and is no URI, pipeline (!), pattern (%,
/// *, ?) or text of several lines. Names are words with _ between them. A bare name is not looked
/// for: it may be anything. A pattern or pipeline that names a device is left to its module too.
bool path_of_parameter(std::string_view name, std::string_view value, NeededPath& path);

/// What this machine has.
std::vector<Finding> diagnose(const Facts& facts);

/// What the graph lacks here. @param facts  with the paths and ports of `needs`.
std::vector<Finding> diagnose(const Needs& needs, const Facts& facts);

/// Whether something is missing or wrong.
bool is_ill(const std::vector<Finding>& findings);

/// "ok       camera      /dev/video0", a line each.
std::string as_text(const std::vector<Finding>& findings);

}  // namespace tool
