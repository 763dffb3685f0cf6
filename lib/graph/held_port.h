// SPDX-License-Identifier: Apache-2.0
#pragma once
// Ports reserved for links between hosts, from the plan until the modules listen.

#include <cstdint>
#include <memory>

#include <hc/os/descriptor.h>

namespace hc {

/// A TCP port that no other program is given. It is bound and nobody listens here, so that a
/// program that knows the number and sets SO_REUSEADDR can listen on it, again and again.
struct HeldPort {
  Descriptor socket;
  std::uint16_t number = 0;
};

/// Holds a port, of 127.0.0.1 or of all addresses, until the last owner of the result releases it.
/// @param number  0: any free one. Errors: System.
Result<std::shared_ptr<const HeldPort>> hold_port(bool of_all_addresses = false,
                                                  std::uint16_t number = 0);

}  // namespace hc
