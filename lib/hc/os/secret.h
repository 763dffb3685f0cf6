// SPDX-License-Identifier: Apache-2.0
#pragma once
// Random secrets.

#include <string>

namespace hc {

/// 128 random bits, in hexadecimal digits.
std::string make_secret();

/// Names the variable of the environment with the secret of a run, which `hc run` makes and no
/// other user can read: with it a restarted module recognizes what its predecessor has signed.
inline constexpr const char* kRunSecret = "HC_SECRET";
/// That of this run; outside of one, a new one.
std::string run_secret();

}  // namespace hc
