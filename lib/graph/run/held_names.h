// SPDX-License-Identifier: Apache-2.0
#pragma once
// The names at which a module is met by the readers of its outputs, listened to for all its
// processes. Names are no secret (/proc/net/unix shows them): were one free while its module
// restarts, another user could take it, and the module would not start again. Internal to graph.

#include <map>
#include <string>
#include <vector>

#include <hc/base/result.h>
#include <hc/os/descriptor.h>

namespace hc::internal {

class HeldNames {
 public:
  /// Listens at each name that this command writes to (`--out PORT=shm:NAME`, `unix-listen:@NAME`),
  /// and lets go of others. Nothing of a command without `--control`, which listens itself
  /// (spec/module.md, section 4).
  ///
  /// Errors: Invalid, System (a name is in use).
  Status hold(const std::vector<std::string>& command);
  /// Lets go of all: who connects is refused from then on.
  void let_go() { held_.clear(); }
  /// For Process::start().
  [[nodiscard]] std::vector<int> descriptors() const;

 private:
  std::map<std::string, Descriptor> held_;  // by the name of the socket
};

}  // namespace hc::internal
