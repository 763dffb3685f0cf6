// SPDX-License-Identifier: Apache-2.0
#include "simulated_line.h"

#include <gtest/gtest.h>

#include <array>

#include <drivers/pan_tilt/serial.h>

namespace {

using hc::pan_tilt::Serial;

constexpr double kStep = 0.0008976;  // of the unit [rad]

/// A line that is plugged in, and a program that has opened it.
class SimulatedLineTest : public ::testing::Test {
 protected:
  void plug() {
    ASSERT_TRUE(*line.plug(true));
    auto opened = Serial::open(line.path(), 9600);
    ASSERT_TRUE(opened) << opened.error().text();
    serial.emplace(std::move(*opened));
  }
  /// The bytes that the unit receives: all, since a read() that finds nothing has waited.
  std::string serve(double time, const Wire::Faults& faults = {}, bool is_silent = false) {
    std::string all;
    for (std::string part; !(part = line.serve(time, faults, is_silent)).empty();) all += part;
    return all;
  }
  std::string answer() {
    std::array<char, 512> room = {};
    std::string all;
    while (true) {
      auto part = serial->read(room);
      if (!part || part->empty()) return all;
      all += *part;
    }
  }

  SimulatedLine line{0, 0, 1};
  std::optional<Serial> serial;
};

TEST_F(SimulatedLineTest, the_unit_obeys_and_answers) {
  plug();
  ASSERT_TRUE(serial->write("ed pp-100 tp-50 "));
  EXPECT_EQ(serve(0), "ed pp-100 tp-50 ");
  EXPECT_TRUE(answer().ends_with("*\r\n*\r\n"));
  EXPECT_NEAR(line.pan(10), -100 * kStep, 1e-5);
  EXPECT_NEAR(line.tilt(10), 50 * kStep, 1e-5);  // down
}

TEST_F(SimulatedLineTest, begins_where_it_is_told_to) {
  const SimulatedLine turned{0.5, -0.1, 1};
  EXPECT_NEAR(turned.pan(0), 0.5, kStep);
  EXPECT_NEAR(turned.tilt(0), -0.1, kStep);
}

TEST_F(SimulatedLineTest, a_silent_unit_obeys) {
  plug();
  ASSERT_TRUE(serial->write("pp100 "));
  serve(0, {}, /*is_silent=*/true);
  EXPECT_EQ(answer(), "");
  EXPECT_NEAR(line.pan(10), 100 * kStep, 1e-5);
}

TEST_F(SimulatedLineTest, an_answer_is_due_after_its_delay) {
  plug();
  EXPECT_EQ(line.pause(0), SimulatedLine::kLook);
  const Wire::Faults late{.delay = 0.01};
  ASSERT_TRUE(serial->write("pp "));
  serve(0, late);
  EXPECT_EQ(answer(), "");
  EXPECT_NEAR(line.pause(0), 0.01, 1e-9);
  serve(0.01, late);
  EXPECT_NE(answer(), "");
  EXPECT_EQ(line.pause(0.01), SimulatedLine::kLook);
}

TEST_F(SimulatedLineTest, the_unit_is_in_time_though_it_is_served_late) {
  plug();
  ASSERT_TRUE(serial->write("pp100 "));
  const Wire::Faults slow{.bytes_per_second = 1000};
  serve(1, slow);
  const double due = 1.006;  // the last byte
  serve(1.1, slow);
  EXPECT_NEAR(line.pan(1.1) / kStep, 1000 * (1.1 - due), 1) << "as if it had been served then";
}

TEST_F(SimulatedLineTest, what_is_on_its_way_is_lost_when_it_is_unplugged) {
  EXPECT_EQ(line.path(), "");
  EXPECT_FALSE(*line.plug(false));
  plug();
  EXPECT_FALSE(*line.plug(true));
  ASSERT_TRUE(serial->write("pp "));
  serve(0, {.delay = 1});
  EXPECT_TRUE(*line.plug(false));
  EXPECT_EQ(line.path(), "");
  EXPECT_EQ(line.descriptor(), -1);
  std::array<char, 64> room = {};
  EXPECT_EQ(serial->read(room).error().code, hc::Code::Closed);
  plug();
  EXPECT_EQ(serve(2), "");
  EXPECT_EQ(answer(), "");
}

}  // namespace
