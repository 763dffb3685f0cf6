// SPDX-License-Identifier: Apache-2.0
#pragma once
// Facts about this machine, and about the files and ports that a graph needs, for `hc doctor`;
// diagnosis.h interprets them.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace tool {

/// Whether something works, by trial.
struct Feature {
  std::string name;
  std::string error;  ///< empty: it can
};

/// Device files of a kind that may be there.
struct Devices {
  std::string kind, where;                          ///< "camera", "/dev/video*"
  std::vector<std::string> open = {}, closed = {};  ///< that this user may use, or not
};

struct Facts {
  std::vector<Feature> kernel;                ///< what links and `hc run` need of it
  std::string release;                        ///< of the kernel, "6.1.0"
  std::uint64_t descriptors = 0;              ///< a process may have open
  std::uint64_t processes = 0;                ///< this user may have; the largest number: any
  std::size_t processors = 0;                 ///< that this process may use
  std::uint64_t memory = 0, free_memory = 0;  ///< [byte]
  std::vector<Devices> devices;
  std::vector<std::string> sound_cards;     ///< their names
  std::string display;                      ///< the variable that names one, with its value
  bool has_graphviz = false;                ///< `dot` is there
  std::vector<std::string> modules;         ///< that can be started
  std::vector<std::string> broken_modules;  ///< in the folder of the modules, but not executable
  /// By questions that were asked: what is wrong, " does not exist"; empty: nothing.
  std::map<std::string, std::string> problems;
};

/// Examines this machine, and answers questions: "read PATH" of a file or device, "write FOLDER",
/// "listen [HOST:]PORT" by TCP.
Facts gather_facts(const std::vector<std::string>& questions);

}  // namespace tool
