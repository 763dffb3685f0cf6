// SPDX-License-Identifier: Apache-2.0
#pragma once
// A key that has no name in any folder: memory of this process, which only its user can open
// (/proc/PID/fd/NUMBER), and those that inherit it. It goes with the last of them. Internal.

#include <string_view>

#include <hc/os/descriptor.h>

namespace hc::hosts {

/// @param key  in PEM. Errors: System.
Result<Descriptor> make_key_file(std::string_view key);

}  // namespace hc::hosts
