// SPDX-License-Identifier: Apache-2.0
#pragma once
// The sets of messages of synchronised inputs, as their links are opened and end. Internal.

#include <vector>

#include <hc/module/inlet.h>

namespace hc {

class Module::Sets {
 public:
  /// @param inlets  of the module; without the focus.
  Sets(Module& module, Delivery& delivery, std::vector<internal::Inlet>& inlets)
      : module_(module), delivery_(delivery), inlets_(inlets) {}

  /// A link was opened, or has ended.
  void begin(const internal::Inlet& inlet);
  void end(const internal::Inlet& inlet);
  /// Ends inputs without a link, unless a command may add one.
  void end_unlinked(bool takes_commands);
  /// Whether messages of a link cannot be part of a set any more.
  [[nodiscard]] static bool are_over(const internal::Inlet& inlet);
  /// Handles the complete sets of those inputs that handle only the newest.
  void handle_newest();
  /// Ends all inputs.
  void end_all();
  void log_dropped() const;

 private:
  [[nodiscard]] bool is_linked(const internal::InputState& input) const;

  Module& module_;
  Delivery& delivery_;
  std::vector<internal::Inlet>& inlets_;
};

}  // namespace hc
