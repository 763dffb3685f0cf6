// SPDX-License-Identifier: Apache-2.0
#include <drivers/pan_tilt/serial.h>

#include <drivers/pan_tilt/pseudo_terminal_test.h>

#include <termios.h>

#include <array>

namespace hc::pan_tilt {
namespace {

TEST(Serial, carries_bytes_as_they_are) {
  PseudoTerminal terminal;
  auto serial = must(Serial::open(terminal.path(), 9600));
  std::array<char, 64> room = {};
  EXPECT_EQ(*serial.read(room), "");
  const std::string all = "pp\r\n\x03\x11\x13\x7f\xff";
  ASSERT_TRUE(serial.write(all));
  EXPECT_EQ(terminal.read(), all);
  terminal.write(all);
  EXPECT_EQ(*serial.read(room), all);
}

TEST(Serial, has_the_settings_that_were_asked_for) {
  PseudoTerminal terminal;
  auto serial = must(Serial::open(terminal.path(), 38400));
  termios settings = {};
  ASSERT_EQ(tcgetattr(serial.descriptor(), &settings), 0);
  EXPECT_EQ(cfgetospeed(&settings), speed_t{B38400});
  EXPECT_EQ(settings.c_cflag & (CSIZE | CSTOPB | PARENB | CRTSCTS), tcflag_t{CS8});
  EXPECT_EQ(settings.c_lflag & (ICANON | ECHO | ISIG), 0U);
}

TEST(Serial, drops_what_came_before) {
  PseudoTerminal terminal;
  terminal.write("* 1\r\n");
  auto serial = must(Serial::open(terminal.path(), 9600));
  std::array<char, 64> room = {};
  EXPECT_EQ(*serial.read(room), "");
}

TEST(Serial, is_one_users_alone) {
  PseudoTerminal terminal;
  {
    const auto first = must(Serial::open(terminal.path(), 9600));
    EXPECT_EQ(refused(Serial::open(terminal.path(), 9600)).text(),
              "System: in use by another program");
  }
  EXPECT_TRUE(Serial::open(terminal.path(), 9600));
}

TEST(Serial, a_device_that_goes_is_noticed) {
  PseudoTerminal terminal;
  auto serial = must(Serial::open(terminal.path(), 9600));
  terminal.unplug();
  std::array<char, 64> room = {};
  EXPECT_EQ(serial.read(room).error().code, Code::Closed);
  EXPECT_EQ(serial.write("h ").error().code, Code::Closed);
}

TEST(Serial, a_line_that_nobody_reads_is_full_some_time_and_does_not_wait) {
  PseudoTerminal terminal;
  auto serial = must(Serial::open(terminal.path(), 9600));
  Status written;
  for (int i = 0; i < 1000 && written; ++i) written = serial.write(std::string(1000, 'x'));
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Code::System);
}

TEST(Serial, what_is_no_line_is_refused) {
  EXPECT_EQ(Serial::open("/no/such/device", 9600).error().code, Code::NotFound);
  EXPECT_EQ(Serial::open("/dev/null", 9600).error().text(), "Unsupported: not a serial line");
  EXPECT_EQ(Serial::open("/dev/null", 9601).error().text(), "Unsupported: no such baud rate: 9601");
}

}  // namespace
}  // namespace hc::pan_tilt
