// SPDX-License-Identifier: Apache-2.0
#include "terminal.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

hc::Result<Terminal> Terminal::open() {
  auto failure = [](const char* call) {
    return hc::Error{hc::Code::System, std::string(call) + ": " + std::strerror(errno)};
  };
  using hc::Descriptor;
  Terminal terminal;
  const int own = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
  if (own < 0) return failure("posix_openpt");
  terminal.own_ = Descriptor(own);
  std::array<char, 64> path = {};
  if (grantpt(own) != 0 || unlockpt(own) != 0 || ptsname_r(own, path.data(), path.size()) != 0)
    return failure("unlockpt");
  terminal.path_ = path.data();
  const int other = ::open(path.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (other < 0) return failure("open");
  terminal.other_ = Descriptor(other);
  // Otherwise the group tty may write to it.
  if (::fchmod(other, S_IRUSR | S_IWUSR) != 0) return failure("fchmod");
  termios settings = {};
  if (tcgetattr(other, &settings) != 0) return failure("open");
  cfmakeraw(&settings);
  if (tcsetattr(other, TCSANOW, &settings) != 0) return failure("tcsetattr");
  return terminal;
}

std::string Terminal::read() {
  std::array<char, 4096> room = {};
  const ssize_t got = ::read(own_.get(), room.data(), room.size());
  return {room.data(), static_cast<std::size_t>(got > 0 ? got : 0)};
}

void Terminal::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t put = ::write(own_.get(), bytes.data(), bytes.size());
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return;
    bytes.remove_prefix(static_cast<std::size_t>(put));
  }
}
