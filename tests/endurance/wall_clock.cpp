// SPDX-License-Identifier: Apache-2.0
// For LD_PRELOAD: the wall clock is off by as many seconds as the file $WALL_CLOCK says now. With
// CLOCK_DRIFT="PPM SINCE", all clocks run faster by PPM parts in a million, since the monotonic one
// was at SINCE [ns]. The kernel continues by its own, so who waits for a moment of such a clock
// waits wrongly, and is found.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/time.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>

namespace {

constexpr long kSecond = 1'000'000'000;  // [ns]

const char* variable(const char* name) {
  return std::getenv(name);  // NOLINT(concurrency-mt-unsafe): nobody sets it
}

time_t offset() {
  const char* name = variable("WALL_CLOCK");
  const int file = name == nullptr ? -1 : ::open(name, O_RDONLY | O_CLOEXEC);
  char text[32] = {};
  if (file >= 0 && ::read(file, text, sizeof text - 1) < 0) text[0] = 0;
  if (file >= 0) ::close(file);
  return std::strtoll(text, nullptr, 10);
}

/// How much a clock is ahead because it runs faster, when the monotonic one is at `now` [ns].
long drifted(const timespec& now) {
  static const char* text = variable("CLOCK_DRIFT");
  char* end = nullptr;
  static const double ppm = text == nullptr ? 0 : std::strtod(text, &end);
  static const long since = end == nullptr ? 0 : std::strtol(end, nullptr, 10);
  const long passed = now.tv_sec * kSecond + now.tv_nsec - since;
  return static_cast<long>(ppm * 1e-6 * static_cast<double>(passed));
}

bool is_wall(clockid_t clock) {
  return clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE;
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  using Function = int(clockid_t, timespec*);
  static auto* real = reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, "clock_gettime"));
  const int result = real(clock, time);
  if (result == 0 && is_wall(clock)) time->tv_sec += offset();
  if (result != 0 || !(is_wall(clock) || clock == CLOCK_MONOTONIC)) return result;
  timespec monotonic{};
  real(CLOCK_MONOTONIC, &monotonic);
  time->tv_nsec += drifted(monotonic);
  while (time->tv_nsec >= kSecond) ++time->tv_sec, time->tv_nsec -= kSecond;
  while (time->tv_nsec < 0) --time->tv_sec, time->tv_nsec += kSecond;
  return result;
}

int gettimeofday(timeval* time, void*) noexcept {
  timespec now{};
  const int result = clock_gettime(CLOCK_REALTIME, &now);
  *time = {now.tv_sec, now.tv_nsec / 1000};
  return result;
}

time_t time(time_t* result) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (result != nullptr) *result = now.tv_sec;
  return now.tv_sec;
}

}  // extern "C"
