// SPDX-License-Identifier: Apache-2.0
#include <graph/run/announcer.h>

#include <gtest/gtest.h>

#include <hc/link/link.h>
#include <hc/mtp/rows.h>

namespace hc::internal {
namespace {

using namespace std::chrono_literals;

class AnnouncerTest : public ::testing::Test {
 protected:
  static Message line(const std::string& text) { return make_rows(std::array{text}); }
  static std::string name() {
    return "@announcer-" + std::to_string(::getpid()) + "-" +
           ::testing::UnitTest::GetInstance()->current_test_info()->name();
  }

  void make(std::function<std::vector<Message>()> welcome = {}) {
    auto made = Announcer::make(*loop_, "unix-listen:" + name(), std::move(welcome));
    ASSERT_TRUE(made) << made.error().detail;
    announcer_ = std::move(*made);
  }
  std::unique_ptr<Source> listen() {
    auto source = open_source({"unix", name(), {}});
    HC_CHECK(source, source.error().detail);
    return std::move(*source);
  }
  void turn_until(const std::function<bool()>& condition) {
    // Conditions outside the loop cause no event, so turn it once per millisecond.
    while (!condition()) {
      auto soon = loop_->call_at(std::chrono::steady_clock::now() + 1ms, [] {});
      ASSERT_TRUE(loop_->turn());
    }
  }
  std::string hear(Source& source) {
    Message message;
    turn_until([&] {
      auto got = source.take(message);
      HC_CHECK(got, got.error().detail);
      return *got == Got::Message;
    });
    return rows_of(message).at(0).substr(0, 20);
  }

  std::unique_ptr<Loop> loop_ = std::move(*Loop::make());
  std::unique_ptr<Announcer> announcer_;
};

TEST_F(AnnouncerTest, AllHearAndWhoComesIsWelcomed) {
  make([&] { return std::vector{line("welcome")}; });
  announcer_->send(line("without a peer"));
  auto first = listen(), second = listen();
  EXPECT_EQ(hear(*first), "welcome");
  EXPECT_EQ(hear(*second), "welcome");
  announcer_->send(line("to both"));
  EXPECT_EQ(hear(*first), "to both");
  EXPECT_EQ(hear(*second), "to both");
  first.reset();
  second.reset();
  turn_until([&] { return !announcer_->has_peers(); });
}

TEST_F(AnnouncerTest, WhoDoesNotListenMissesWholeMessages) {
  make();
  auto source = listen();
  turn_until([&] { return announcer_->has_peers(); });
  const std::string large(Announcer::kMaxQueued / 4, 'x');
  bool has_room = true;
  for (int i = 0; i < 16; ++i) has_room = announcer_->send(line(std::to_string(i) + " " + large));
  EXPECT_FALSE(has_room);
  std::string last = hear(*source);
  EXPECT_EQ(last.substr(0, 2), "0 ");
  announcer_->send(line("end"));
  while ((last = hear(*source)) != "end" && last.substr(0, 2) != "15") {
    announcer_->send(line("end"));
  }
}

TEST_F(AnnouncerTest, WhoReadsNothingMakesPlaceForWhoComes) {
  make([&] { return std::vector{line("welcome")}; });
  auto reader = listen();
  EXPECT_EQ(hear(*reader), "welcome");
  std::vector<std::unique_ptr<Source>> idle;
  for (std::size_t i = 1; i < Announcer::kMaxPeers; ++i) idle.push_back(listen());
  auto late = listen();
  EXPECT_EQ(hear(*late), "welcome");
  announcer_->send(line("to all"));
  EXPECT_EQ(hear(*reader), "to all");
  EXPECT_EQ(hear(*late), "to all");
}

TEST_F(AnnouncerTest, ANameInUseIsAnError) {
  make();
  EXPECT_FALSE(Announcer::make(*loop_, "unix-listen:" + name()));
}

TEST_F(AnnouncerTest, OneMessageIsSaidAtOnceOrNotAtAll) {
  auto source = open_source({"unix-listen", name(), {}});
  ASSERT_TRUE(source);
  ASSERT_TRUE(send_at_once("unix:" + name(), line("said")));
  EXPECT_EQ(hear(**source), "said");
  source->reset();
  auto refused = send_at_once("unix:" + name(), line("said"));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::Closed);
  EXPECT_EQ(send_at_once("tcp:1", line("said")).error().code, Code::Invalid);
}

}  // namespace
}  // namespace hc::internal
