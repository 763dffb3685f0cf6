// SPDX-License-Identifier: Apache-2.0
#pragma once
// Random secrets.

#include <string>

namespace hc {

/// 128 random bits in hexadecimal.
std::string make_secret();

/// The environment variable with the secret of a run, which `hc run` sets and other users cannot
/// read; it lets a restarted module verify what its predecessor has signed.
inline constexpr const char* kRunSecret = "HC_SECRET";
/// The secret of this run; outside of `hc run`, a new one.
std::string run_secret();

}  // namespace hc
