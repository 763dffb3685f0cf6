// SPDX-License-Identifier: Apache-2.0
// For LD_PRELOAD: the wall clock is off by as many seconds as the file $WALL_CLOCK says now. The
// kernel continues by its own, so who waits for a moment of this clock waits wrongly, and is found.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/time.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>

namespace {

time_t offset() {
  const char* name = std::getenv("WALL_CLOCK");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  const int file = name == nullptr ? -1 : ::open(name, O_RDONLY | O_CLOEXEC);
  char text[32] = {};
  if (file >= 0 && ::read(file, text, sizeof text - 1) < 0) text[0] = 0;
  if (file >= 0) ::close(file);
  return std::strtoll(text, nullptr, 10);
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
