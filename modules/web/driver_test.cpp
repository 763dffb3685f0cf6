// SPDX-License-Identifier: Apache-2.0
#include "driver.h"

#include <limits>

#include <gtest/gtest.h>
#include <hc/module/kind.h>
#include <hc/testing/must.h>

namespace {

using std::chrono::milliseconds;
using namespace std::chrono_literals;

constexpr hc::Time kWall(1'700'000'000s);
const std::set<std::int32_t> kModes = {1, 4, 5};

hc::Message from(Control control, hc::Message message, std::int32_t coord = 0,
                 std::int32_t mode = 0) {
  message.header.src = static_cast<std::int32_t>(control);
  if (coord != 0) message.header.coord = coord;
  message.header.mode = mode;
  return message;
}

hc::Message stick(double left, double down) {
  return from(Control::Stick, hc::table().message({left, down}));
}
hc::Message bid(double salience, int mode) {
  return from(Control::Bid, hc::table().message({salience}), 0, mode);
}

hc::Message name(std::string_view text) {
  return from(Control::Name, hc::string().message(text));
}
hc::Message hold(double track) {
  return from(Control::Hold, hc::table().message({track}));
}

double number(const Order& order, std::size_t i = 0) {
  return hc::view<double>(order.message)->numbers()[i];
}

TEST(Driver, what_is_commanded_is_passed_on_with_a_time) {
  Driver driver;
  const auto orders = hc::must(driver.take(stick(0.5, -1), kModes, kWall, {}));
  ASSERT_EQ(orders.size(), 1U);
  EXPECT_EQ(orders.front().control, Control::Stick);
  EXPECT_EQ(orders.front().message.header.time, kWall);
  EXPECT_EQ(number(orders.front(), 1), -1);
  using hc::Coord;
  EXPECT_TRUE(driver.take(
      from(Control::Rotation, hc::rotation().message({0.1, 0.2, 0.3}), Coord::kSupervisor), kModes,
      kWall, {}));
  EXPECT_TRUE(driver.take(
      from(Control::Target, hc::position().message({400., 300., 0.}), Coord::kRightImage), kModes,
      kWall, {}));
  EXPECT_TRUE(driver.take(from(Control::Text, hc::string().message("hello")), kModes, kWall, {}));
}

TEST(Driver, what_comes_is_of_now_and_addressed_to_nobody) {
  Driver driver;
  for (const hc::Time time : {hc::unix_time(1), kWall - 1h, kWall + 1h, hc::Time::max()}) {
    hc::Message messages[] = {stick(1, 0), bid(1, 5),
                              from(Control::Text, hc::string().message("hello")),
                              from(Control::Rotation, hc::rotation().message({0., 0., 0.}), 14)};
    for (auto& message : messages) {
      message.header.time = time;
      message.header.dst = 7;
      const auto orders = hc::must(driver.take(message, kModes, kWall, {}));
      EXPECT_EQ(orders.front().message.header.time, kWall);
      EXPECT_EQ(orders.front().message.header.dst, 0);
    }
    // A target keeps the time of its image, which must be recent.
    auto target = from(Control::Target, hc::position().message({1., 1., 0.}), 7, 5);
    target.header.time = time;
    EXPECT_EQ(hc::refused(driver.take(target, kModes, kWall, {})).code, hc::Code::Invalid);
    target.header.time = kWall - 500ms;
    const auto orders = hc::must(driver.take(target, kModes, kWall, {}));
    EXPECT_EQ(orders.front().message.header.time, kWall - 500ms);
    EXPECT_EQ(orders.front().message.header.mode, 0);
  }
}

TEST(Driver, anything_else_is_refused) {
  Driver driver;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const hc::Message wrong[] = {
      stick(1.1, 0),
      stick(kNan, 0),
      from(Control::Stick, hc::table().message({0.0})),
      from(Control::Stick, hc::table<float>().message({0, 0})),
      from(Control::Rotation, hc::rotation().message({0., 0., 0.}), 3),
      from(Control::Target, hc::position().message({0., 0., 0.}), hc::Coord::kWorld),
      from(Control::Target, hc::position().message({kNan, 0., 0.}), hc::Coord::kLeftImage),
      from(Control::Text, hc::table().message({0.0})),
      from(Control::Text, hc::string().message(std::string(4097, 'a'))),
      bid(2, 1),
      bid(0.5, 0),
      bid(0.5, 2),  // a mode unknown to the graph
      from(Control::Text, hc::string().message("hello"), 0, 2),
      from(static_cast<Control>(8), hc::table().message({0.0})),
      from(static_cast<Control>(2147483647), hc::table().message({0.0}))};
  for (const auto& message : wrong) {
    EXPECT_EQ(hc::refused(driver.take(message, kModes, kWall, {})).code, hc::Code::Malformed);
  }
}

TEST(Driver, a_person_is_named_and_held_by_their_track) {
  Driver driver;
  for (const auto* text : {"1 Ann", "2147483647 Zoë van der Berg", "7 a.b"}) {
    const auto orders = hc::must(driver.take(name(text), kModes, kWall, {}));
    ASSERT_EQ(orders.size(), 1U);
    EXPECT_EQ(orders[0].control, Control::Name);
    const auto& bytes = orders[0].message.elements;
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), text);
  }
  for (const double track : {1.0, 2147483647.0, 0.0}) {
    const auto orders = hc::must(driver.take(hold(track), kModes, kWall, {}));
    ASSERT_EQ(orders.size(), 1U);
    EXPECT_EQ(orders[0].control, Control::Hold);
    EXPECT_EQ(number(orders[0]), track);
  }
}

TEST(Driver, what_is_no_name_or_no_track_is_refused) {
  Driver driver;
  const std::string long_name(65, 'a');
  for (const std::string& text :
       {std::string(), std::string("Ann"), std::string("1"), std::string("1 "),
        std::string("0 Ann"), std::string("-1 Ann"), std::string("2147483648 Ann"),
        std::string("1.5 Ann"), std::string(" 1 Ann"), std::string("1 .Ann"),
        std::string("1 ../Ann"), std::string("1 A/nn"), std::string("1 A\x01nn"),
        std::string("1 Ann\x7f"), std::string("1 Ann\n2 Bob"), std::string("1 Zo\xeb"),
        "1 " + long_name})
    EXPECT_EQ(hc::refused(driver.take(name(text), kModes, kWall, {})).code, hc::Code::Malformed)
        << text;
  EXPECT_EQ(
      hc::refused(driver.take(from(Control::Name, hc::table().message({1.0})), kModes, kWall, {}))
          .code,
      hc::Code::Malformed);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double track : {-1.0, 0.5, 2147483648.0, 1e300, kNan})
    EXPECT_EQ(hc::refused(driver.take(hold(track), kModes, kWall, {})).code, hc::Code::Malformed);
  EXPECT_EQ(hc::refused(driver.take(from(Control::Hold, hc::table().message({1.0, 2.0})), kModes,
                                    kWall, {}))
                .code,
            hc::Code::Malformed);
}

TEST(Driver, who_leaves_holds_nobody) {
  Driver driver;
  const hc::MonotonicTime begin{};
  ASSERT_TRUE(driver.take(hold(3), kModes, kWall, begin));
  const auto ended = driver.tick(kWall, begin + milliseconds(201));
  ASSERT_EQ(ended.size(), 1U);
  EXPECT_EQ(ended[0].control, Control::Hold);
  EXPECT_EQ(number(ended[0]), 0);
  ASSERT_TRUE(driver.take(hold(3), kModes, kWall, begin));
  ASSERT_TRUE(driver.take(hold(0), kModes, kWall, begin));
  EXPECT_TRUE(driver.leave(kWall).empty());
}

TEST(Driver, who_is_silent_for_200_ms_commands_nothing) {
  Driver driver;
  const hc::MonotonicTime begin{};
  ASSERT_TRUE(driver.take(stick(1, 0), kModes, kWall, begin));
  ASSERT_TRUE(driver.take(bid(1, 5), kModes, kWall, begin));
  EXPECT_TRUE(driver.tick(kWall, begin + milliseconds(99)).empty());
  const auto again = driver.tick(kWall + 1ns, begin + milliseconds(100));
  ASSERT_EQ(again.size(), 1U);  // the bid is repeated
  EXPECT_EQ(again[0].message.header.mode, 5);
  EXPECT_EQ(number(again[0]), 1);
  EXPECT_EQ(again[0].message.header.time, kWall + 1ns);
  const auto ended = driver.tick(kWall, begin + milliseconds(201));
  ASSERT_EQ(ended.size(), 2U);
  EXPECT_EQ(ended[0].control, Control::Stick);
  EXPECT_EQ(number(ended[0], 0), 0);
  EXPECT_EQ(ended[0].message.header.width, 2);
  EXPECT_EQ(ended[1].control, Control::Bid);
  EXPECT_EQ(ended[1].message.header.mode, 5);
  EXPECT_EQ(number(ended[1]), 0);
  EXPECT_TRUE(driver.tick(kWall, begin + milliseconds(300)).empty());
  // And its bids are accepted again.
  EXPECT_EQ(driver.take(stick(1, 0), kModes, kWall, begin + milliseconds(400))->size(), 1U);
}

TEST(Driver, a_sign_of_life_keeps_what_is_commanded) {
  Driver driver;
  const hc::MonotonicTime begin{};
  ASSERT_TRUE(driver.take(stick(1, 0), kModes, kWall, begin));
  EXPECT_TRUE(driver
                  .take(from(Control::Alive, hc::table().message({0.0})), kModes, kWall,
                        begin + milliseconds(150))
                  ->empty());
  EXPECT_TRUE(driver.tick(kWall, begin + milliseconds(300)).empty());
  EXPECT_EQ(driver.tick(kWall, begin + milliseconds(351)).size(), 1U);
}

TEST(Driver, another_task_takes_the_place_of_the_one_before) {
  Driver driver;
  ASSERT_TRUE(driver.take(bid(1, 4), kModes, kWall, {}));
  const auto orders = driver.take(bid(1, 5), kModes, kWall, {});
  ASSERT_EQ(orders->size(), 2U);
  // The new bid comes first, so that no other task gets the focus in between.
  EXPECT_EQ((*orders)[0].message.header.mode, 5);
  EXPECT_EQ(number((*orders)[0]), 1);
  EXPECT_EQ((*orders)[1].message.header.mode, 4);
  EXPECT_EQ(number((*orders)[1]), 0);
  EXPECT_EQ((*orders)[1].message.header.time, kWall);
  EXPECT_EQ(driver.take(bid(0, 5), kModes, kWall, {})->size(), 1U);
  EXPECT_TRUE(driver.leave(kWall).empty());
}

}  // namespace
