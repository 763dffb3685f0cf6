// SPDX-License-Identifier: Apache-2.0
#pragma once
// The sets of messages that synchronised inputs make, as links come and go. Internal.

#include <vector>

#include <hc/module/inlet.h>

namespace hc {

class Module::Sets {
 public:
  /// @param inlets  of the module; without the focus.
  Sets(Module& module, Delivery& delivery, std::vector<internal::Inlet>& inlets)
      : module_(module), delivery_(delivery), inlets_(inlets) {}

  /// Says that a link was opened, or has ended.
  void begin(const internal::Inlet& inlet);
  void end(const internal::Inlet& inlet);
  /// Ends inputs without a link, unless commands may give them one.
  void end_unlinked(bool takes_commands);
  /// Whether the messages of a link can have no partners any more.
  [[nodiscard]] static bool are_over(const internal::Inlet& inlet);
  /// Handles complete sets of inputs that handle the newest only.
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
