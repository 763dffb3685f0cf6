// SPDX-License-Identifier: Apache-2.0
#pragma once
// A running graph in Foxglove's terms: channels, parameters and the connection graph, from the
// graph's state (spec/graph.md, G45) and the descriptions of its modules. For one thread.

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/parameter.h>
#include <hc/contract/description.h>
#include <hc/contract/graph_state.h>

#include "json.h"
#include "publisher.h"

class Catalog {
 public:
  /// @param jpeg  send u8 images as CompressedImage.
  explicit Catalog(bool jpeg);

  struct Changes {
    std::vector<Channel> added, removed;
    std::vector<std::string> parameters;  ///< names of changed parameters
    bool graph = false;                   ///< the connection graph changed
    std::vector<std::string> unknown;     ///< modules to be described
  };
  Changes take_state(const hc::GraphState& state);
  /// Takes a module's output of `--describe`; no changes if it is invalid.
  Changes describe(const std::string& module, std::string_view description);

  /// By id.
  [[nodiscard]] const std::map<std::uint32_t, Channel>& channels() const { return channels_; }

  /// {"op":"advertise","channels":[…]}
  [[nodiscard]] static std::string advertise(const std::vector<Channel>& channels);
  [[nodiscard]] static std::string unadvertise(const std::vector<Channel>& channels);
  /// {"op":"connectionGraphUpdate",…}, the whole graph.
  [[nodiscard]] std::string connection_graph() const;
  /// {"op":"parameterValues",…} of the named parameters that exist, each once.
  /// @param set  text values that replace the known ones, by name.
  [[nodiscard]] std::string parameter_values(
      const std::vector<std::string>& names, const std::string& id,
      const std::map<std::string, std::string>& set = {}) const;
  [[nodiscard]] std::vector<std::string> parameter_names() const;
  /// @param name  MODULE.NAME.
  [[nodiscard]] bool has_parameter(const std::string& name) const {
    return parameters_.contains(name);
  }

  /// The channels that are not outputs of modules.
  [[nodiscard]] const Channel& log() const { return channels_.at(kLog); }
  [[nodiscard]] const Channel& frames() const { return channels_.at(kFrames); }

 private:
  static constexpr std::uint32_t kLog = 1, kFrames = 2;
  using Names = std::map<std::string, std::vector<std::string>>;  // of modules, by topic

  void remove_outputs(const std::string& module, Changes& changes);

  const bool jpeg_;
  std::uint32_t next_ = kFrames + 1;
  std::map<std::uint32_t, Channel> channels_;
  std::map<std::string, std::string> programs_;           // by module
  std::map<std::string, hc::ParameterState> parameters_;  // by MODULE.NAME
  std::map<std::string, std::string> values_;             // from the state, by MODULE.NAME
  Names published_, taken_;
};
