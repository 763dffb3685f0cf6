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
  Terminal terminal;
  terminal.own_ = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
  if (terminal.own_ < 0) return failure("posix_openpt");
  std::array<char, 64> path = {};
  if (grantpt(terminal.own_) != 0 || unlockpt(terminal.own_) != 0 ||
      ptsname_r(terminal.own_, path.data(), path.size()) != 0)
    return failure("unlockpt");
  terminal.path_ = path.data();
  terminal.other_ = ::open(path.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  // Else whoever is in the group tty may write to it.
  if (terminal.other_ >= 0 && ::fchmod(terminal.other_, S_IRUSR | S_IWUSR) != 0)
    return failure("fchmod");
  termios settings = {};
  if (terminal.other_ < 0 || tcgetattr(terminal.other_, &settings) != 0) return failure("open");
  cfmakeraw(&settings);
  if (tcsetattr(terminal.other_, TCSANOW, &settings) != 0) return failure("tcsetattr");
  return terminal;
}

Terminal& Terminal::operator=(Terminal&& other) noexcept {
  std::swap(own_, other.own_);
  std::swap(other_, other.other_);
  std::swap(path_, other.path_);
  return *this;
}

Terminal::~Terminal() {
  if (own_ >= 0) ::close(own_);
  if (other_ >= 0) ::close(other_);
}

std::string Terminal::read() {
  std::array<char, 4096> room = {};
  const ssize_t got = ::read(own_, room.data(), room.size());
  return {room.data(), static_cast<std::size_t>(got > 0 ? got : 0)};
}

void Terminal::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t put = ::write(own_, bytes.data(), bytes.size());
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return;
    bytes.remove_prefix(static_cast<std::size_t>(put));
  }
}
