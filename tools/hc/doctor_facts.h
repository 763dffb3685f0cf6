// SPDX-License-Identifier: Apache-2.0
#pragma once
// Gathers facts about this machine, and about files and ports that a graph needs, for `hc doctor`;
// doctor_findings.h interprets them.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace tool {

/// A kernel feature, tested by use.
struct Feature {
  std::string name;
  std::string error;  ///< empty: it works
};

/// Device files of a kind.
struct Devices {
  std::string kind, where;                          ///< such as "camera", "/dev/video*"
  std::vector<std::string> open = {}, closed = {};  ///< usable by this user, or not
};

struct Facts {
  std::vector<Feature> kernel;                ///< features needed by links and `hc run`
  std::string release;                        ///< of the kernel, such as "Linux 6.1.0"
  std::uint64_t descriptors = 0;              ///< limit for a process
  std::uint64_t processes = 0;                ///< limit for this user; largest number: none
  std::size_t processors = 0;                 ///< usable by this process
  std::uint64_t memory = 0, free_memory = 0;  ///< [byte]
  std::vector<Devices> devices;
  std::vector<std::string> sound_cards;     ///< names
  std::string display;                      ///< the environment variable, with its value
  bool has_graphviz = false;                ///< `dot` is installed
  std::vector<std::string> modules;         ///< executable
  std::string networks_folder;              ///< of the weights of neural networks
  std::vector<std::string> networks;        ///< those that are there
  std::vector<std::string> broken_modules;  ///< in the folder of modules, but not executable
  /// By question: the problem, such as " does not exist"; empty: none.
  std::map<std::string, std::string> problems;
};

/// Examines this machine, and answers questions: "read PATH" for a file or device, "write FOLDER",
/// "listen [HOST:]PORT" for TCP.
Facts gather_facts(const std::vector<std::string>& questions);

/// The answer to such a question; empty: no problem.
std::string problem_of(const std::string& question);

}  // namespace tool
