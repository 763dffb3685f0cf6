// SPDX-License-Identifier: Apache-2.0
#pragma once
// A key file in memory, without a path: readable only by this user (/proc/PID/fd/NUMBER) and by
// processes that inherit it; freed with the last of them. Internal.

#include <string_view>

#include <hc/os/descriptor.h>

namespace hc::hosts {

/// @param key  in PEM. Errors: System.
Result<Descriptor> make_key_file(std::string_view key);

}  // namespace hc::hosts
