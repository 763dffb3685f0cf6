// SPDX-License-Identifier: Apache-2.0
#pragma once
// TCP ports reserved for links, from planning until the modules listen.

#include <cstdint>
#include <memory>

#include <hc/os/descriptor.h>

namespace hc {

/// A reserved TCP port. The socket is bound but does not listen, so that a program that knows the
/// number and sets SO_REUSEADDR can listen on it, repeatedly, and no other program is given it.
struct HeldPort {
  Descriptor socket;
  std::uint16_t number = 0;
};

/// Reserves a port of 127.0.0.1, or of all addresses, for the lifetime of the result.
/// @param number  0: any free port. Errors: System.
Result<std::shared_ptr<const HeldPort>> hold_port(bool of_all_addresses = false,
                                                  std::uint16_t number = 0);

}  // namespace hc
