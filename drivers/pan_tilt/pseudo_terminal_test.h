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

#include <hc/testing/must.h>

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
  /// Everything written: read() may return only part of it; a read() that finds nothing has waited
  /// for the rest.
  std::string read() {
    std::string all;
    std::array<char, 4096> room = {};
    for (ssize_t got = 0; (got = ::read(own_, room.data(), room.size())) > 0;)
      all.append(room.data(), static_cast<std::size_t>(got));
    return all;
  }
  void write(std::string_view bytes) {
    EXPECT_EQ(::write(own_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }

 private:
  int own_;
  std::string path_;
};

}  // namespace hc::pan_tilt
