// SPDX-License-Identifier: Apache-2.0
#pragma once
// Points at which a test kills the process, as by `kill -9`. Internal; empty in a normal build.

#ifdef HC_CRASH_POINTS
#include <csignal>
#include <cstdlib>
#include <string_view>

namespace hc::internal {

/// Kills the process if the environment has HC_CRASH_AT=NAME; NAME:COUNT the COUNT-th time.
inline void crash_point(std::string_view name) {
  static const char* const kWanted = std::getenv("HC_CRASH_AT");
  if (kWanted == nullptr) return;
  std::string_view wanted(kWanted);
  auto colon = wanted.find(':');
  if (wanted.substr(0, colon) != name) return;
  static long left = colon == std::string_view::npos ? 1 : std::atol(kWanted + colon + 1);
  if (--left == 0) std::raise(SIGKILL);
}

}  // namespace hc::internal

#define HC_CRASH_POINT(name) ::hc::internal::crash_point(name)
#else
#define HC_CRASH_POINT(name) static_cast<void>(0)
#endif
