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

/// A device file that may be there.
struct Device {
  std::string path;
  bool opens = true;  ///< it may be opened for what it is for
};

/// A path, seen by this user.
struct PathState {
  bool is_there = false;
  bool is_readable = false;
  bool is_folder = false;
  bool is_writable = false;
};

struct Facts {
  std::vector<Feature> kernel;                ///< what links and `hc run` need of it
  std::string release;                        ///< of the kernel, "6.1.0"
  std::uint64_t descriptors = 0;              ///< a process may have open
  std::uint64_t processes = 0;                ///< this user may have; the largest number: any
  std::size_t processors = 0;                 ///< that this process may use
  std::uint64_t memory = 0, free_memory = 0;  ///< [byte]
  std::vector<Device> cameras, sounds, serials, joysticks, renderers;
  std::vector<std::string> sound_cards;      ///< their names
  std::string display;                       ///< the variable that names one, with its value
  bool has_graphviz = false;                 ///< `dot` is there
  std::vector<std::string> modules;          ///< that can be started
  std::vector<std::string> broken_modules;   ///< in the folder of the modules, but not executable
  std::map<std::string, PathState> paths;    ///< those that were asked for
  std::map<std::string, std::string> ports;  ///< [HOST:]PORT: why nobody can listen, or empty
};

/// Examines this machine, these paths and these TCP ports ([HOST:]PORT).
Facts gather_facts(const std::vector<std::string>& paths = {},
                   const std::vector<std::string>& ports = {});

}  // namespace tool
