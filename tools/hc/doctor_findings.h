// SPDX-License-Identifier: Apache-2.0
#pragma once
// The findings of `hc doctor`, from facts about a machine and the needs of a graph. Pure.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <graph/plan.h>

#include "doctor_facts.h"

namespace tool {

enum class Mark {
  Ok,
  Missing,  ///< required by hc or the graph
  Wrong,    ///< a problem of the graph file
  Note,     ///< informational
};

struct Finding {
  Mark mark = Mark::Ok;
  std::string what;  ///< subject, such as "camera", or a module of the graph
  std::string text;
};

/// A file, device, folder or TCP port that a run opens.
struct Need {
  std::string module;
  std::string text;      ///< such as "parameter source: /data/a.jpg"
  std::string question;  ///< for gather_facts(), such as "read /data/a.jpg"
};

/// The resources that a graph needs.
struct Needs {
  std::size_t modules = 0;
  std::vector<std::string> viewers;  ///< modules `view` that are to show a window
  std::vector<Need> places;

  [[nodiscard]] std::vector<std::string> questions() const;
};

/// The resources that a plan needs: ports on which its links listen, files of its links, and files
/// or devices named by parameters (see need_of_parameter).
Needs needs_of(const hc::Plan& plan);

/// The file, device or folder named by a parameter, if any:
///
/// - a path to read, which must exist, if the value begins with /dev/ or a word of the name is
///   source, file, path, folder, directory, device, model or config;
/// - a path to write, whose folder must exist, if such a word is save, output, log or record.
///
/// The words of a name are separated by _. The value must contain a / or end like a file's name,
/// and must not be a URI, a pipeline (!), a pattern (%, *, ?) or text of several lines: those are
/// left to the module.
std::optional<Need> need_of_parameter(const std::string& module, std::string_view name,
                                      std::string_view value);

/// Findings about this machine.
std::vector<Finding> diagnose(const Facts& facts);

/// Findings about a graph on this machine. @param facts  with answers to needs.questions().
std::vector<Finding> diagnose(const Needs& needs, const Facts& facts);

/// Whether something is missing or wrong.
bool is_ill(const std::vector<Finding>& findings);

/// A line for each finding, such as "ok       camera      /dev/video0".
std::string as_text(const std::vector<Finding>& findings);

}  // namespace tool
