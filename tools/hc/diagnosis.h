// SPDX-License-Identifier: Apache-2.0
#pragma once
// From facts, and from what a graph needs, to the lines of `hc doctor`. Pure.

#include <optional>
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

/// A file, device, folder or TCP port that a run opens.
struct Need {
  std::string module;
  std::string text;      ///< "parameter source: /data/a.jpg"
  std::string question;  ///< of gather_facts(): "read /data/a.jpg"
};

/// The resources that a graph needs.
struct Needs {
  std::size_t modules = 0;
  std::vector<std::string> viewers;  ///< modules `view` that do not save
  std::vector<Need> places;

  [[nodiscard]] std::vector<std::string> questions() const;
};

/// What of a plan is to be looked for on this machine: ports where its links listen, files of its
/// links, and parameters that name a file or a device (see need_of_parameter).
Needs needs_of(const hc::Plan& plan);

/// The path that a parameter names, if it does. It does
///
/// - where the value begins with /dev/ or a word of its name is source, file, path, folder,
///   directory, device, model or config: what is read must be there;
/// - where a word of its name is save, output, log or record: the folder must be there;
///
/// and the value begins with / or ./ or ../, or holds a /, and is no URI, pipeline (!), pattern (%,
/// *, ?) or text of several lines. Names are words with _ between them. A bare name is not looked
/// for: it may be anything. A pattern or pipeline that names a device is left to its module too.
std::optional<Need> need_of_parameter(const std::string& module, std::string_view name,
                                      std::string_view value);

/// What this machine has.
std::vector<Finding> diagnose(const Facts& facts);

/// What the graph lacks here. @param facts  with the questions of `needs` answered.
std::vector<Finding> diagnose(const Needs& needs, const Facts& facts);

/// Whether something is missing or wrong.
bool is_ill(const std::vector<Finding>& findings);

/// "ok       camera      /dev/video0", a line each.
std::string as_text(const std::vector<Finding>& findings);

}  // namespace tool
