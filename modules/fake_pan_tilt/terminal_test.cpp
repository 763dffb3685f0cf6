// SPDX-License-Identifier: Apache-2.0
#include "terminal.h"

#include <gtest/gtest.h>

#include <array>
#include <optional>

#include <drivers/pan_tilt/serial.h>
#include <hc/testing/must.h>

namespace {

TEST(Terminal, is_a_serial_line_that_may_be_left_and_opened_again) {
  auto opened = hc::must(Terminal::open());
  Terminal terminal = std::move(opened);
  for (int i = 0; i < 3; ++i) {
    auto serial = hc::pan_tilt::Serial::open(terminal.path(), 9600);
    ASSERT_TRUE(serial) << serial.error().text();
    ASSERT_TRUE(serial->write("pp "));
    EXPECT_EQ(terminal.read(), "pp ");
    terminal.write("* 22\r\n");
    std::array<char, 64> room = {};
    EXPECT_EQ(*serial->read(room), "* 22\r\n");
  }
  EXPECT_EQ(terminal.read(), "");
}

TEST(Terminal, does_not_wait_when_nobody_reads) {
  auto terminal = hc::must(Terminal::open());
  for (int i = 0; i < 100; ++i) terminal.write(std::string(1000, 'x'));
}

TEST(Terminal, leaves_nothing_behind) {
  std::optional<Terminal> terminal;
  auto opened = hc::must(Terminal::open());
  terminal.emplace(std::move(opened));
  auto serial = hc::must(hc::pan_tilt::Serial::open(terminal->path(), 9600));
  terminal.reset();
  std::array<char, 64> room = {};
  EXPECT_EQ(serial.read(room).error().code, hc::Code::Closed);
}

}  // namespace
