// SPDX-License-Identifier: Apache-2.0
#pragma once
// The other end of a serial line, for tests.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <string>
#include <string_view>

namespace hc::pan_tilt {

class PseudoTerminal {
 public:
  PseudoTerminal() : own_(posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK)) {
    EXPECT_EQ(grantpt(own_), 0);
    EXPECT_EQ(unlockpt(own_), 0);
    std::array<char, 64> path = {};
    EXPECT_EQ(ptsname_r(own_, path.data(), path.size()), 0);
    path_ = path.data();
  }
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;
  ~PseudoTerminal() { unplug(); }

  [[nodiscard]] const std::string& path() const { return path_; }
  void unplug() {
    if (own_ >= 0) ::close(own_);
    own_ = -1;
  }
  std::string read() {
    std::array<char, 4096> room = {};
    const ssize_t got = ::read(own_, room.data(), room.size());
    return {room.data(), static_cast<std::size_t>(got > 0 ? got : 0)};
  }
  void write(std::string_view bytes) {
    EXPECT_EQ(::write(own_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }

 private:
  int own_;
  std::string path_;
};

}  // namespace hc::pan_tilt
