// SPDX-License-Identifier: Apache-2.0
#pragma once
// Holds the socket names of a module's outputs across its processes. Names are public
// (/proc/net/unix): if one were free while its module restarts, another user could take it, and the
// module could not start again. Internal to graph.

#include <map>
#include <string>
#include <vector>

#include <hc/base/result.h>
#include <hc/os/descriptor.h>

namespace hc::internal {

class HeldNames {
 public:
  /// Listens at each name to which this command writes (`--out PORT=shm:NAME`,
  /// `unix-listen:@NAME`), and releases all others. Holds none for a command without `--control`,
  /// which listens itself (spec/module.md, section 4).
  ///
  /// Errors: Invalid, System (a name is in use).
  Status hold(const std::vector<std::string>& command);
  /// Releases all names; connections are refused from then on.
  void release() { held_.clear(); }
  /// For Inherited::listeners.
  [[nodiscard]] std::vector<int> descriptors() const;

 private:
  std::map<std::string, Descriptor> held_;  // by name of the socket
};

}  // namespace hc::internal
