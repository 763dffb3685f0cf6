// SPDX-License-Identifier: Apache-2.0
#include <hc/link/stream/dialer.h>

#include <gtest/gtest.h>

#include <sys/socket.h>
#include <unistd.h>
#include <array>

#include <algorithm>
#include <string>
#include <vector>

#include <hc/link/stream/ends.h>
#include <hc/testing/loopback.h>

namespace hc::testing {
namespace {

using internal::Dialer;
using internal::TimePoint;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;

// The first pauses are within 100, 200, 400, 800, 1600 and 3200 ms, and all others within 5 s.
constexpr std::array<milliseconds, 9> kBounds = {
    milliseconds(100),  milliseconds(200),  milliseconds(400),
    milliseconds(800),  milliseconds(1600), milliseconds(3200),
    milliseconds(5000), milliseconds(5000), milliseconds(5000)};

TEST(Dialer, APauseIsAnywhereBelowABoundThatDoublesUpTo5Seconds) {
  constexpr int kSeeds = 2000, kParts = 10;
  for (std::size_t number = 0; number < kBounds.size(); ++number) {
    std::array<int, kParts> drawn{};
    for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
      std::minstd_rand random(seed * 7919);
      Backoff backoff(internal::kFirstPause, internal::kLongestPause);
      for (std::size_t i = 0; i < number; ++i) backoff.next();
      nanoseconds pause = internal::draw_pause(backoff, random);
      ASSERT_GE(pause, nanoseconds(0));
      ASSERT_LE(pause, kBounds.at(number));
      auto part = kParts * pause / (nanoseconds(kBounds.at(number)) + nanoseconds(1));
      ++drawn.at(static_cast<std::size_t>(part));
    }
    // As often in each tenth of the interval, but for 5 standard deviations.
    for (int count : drawn) EXPECT_NEAR(count, kSeeds / kParts, 5 * 13.5) << number;
  }
}

/// Time that a test turns by hand, and a peer that may listen or not.
class DialerTest : public ::testing::Test {
 protected:
  [[nodiscard]] Dialer dialer(seconds first = seconds(60), seconds patience = seconds(60)) const {
    return {{internal::unix_peer(*parse_uri("unix:" + name_))->addresses, "peer", admit_},
            first,
            patience,
            now_};
  }
  void listen() {
    auto socket = internal::listen_unix(*parse_uri("unix-listen:" + name_));
    ASSERT_TRUE(socket) << socket.error().text();
    listening_ = std::move(*socket);
  }
  /// Whether there is a connection when it is tried now.
  bool connects(Dialer& dialer) const {
    auto made = dialer.dial(now_);
    EXPECT_TRUE(made) << made.error().text();
    return made && *made;
  }
  /// The peer goes. @param was_of_use  as lost() has it.
  void lose(Dialer& dialer, bool was_of_use = true) {
    listening_ = {};
    dialer.lost(now_, was_of_use, "it has gone");
  }
  /// Tries until a moment, in vain.
  void fail_until(Dialer& dialer, TimePoint end) {
    for (; now_ < end; now_ = dialer.due()) EXPECT_FALSE(connects(dialer));
    EXPECT_EQ(now_, end);  // due() says no later
  }
  void log(Dialer& dialer) {
    dialer.log_to([&](Level, std::string_view line) { lines_.emplace_back(line); });
  }
  /// Lets tries fail until each pause is drawn from 5 s.
  void tire(Dialer& dialer) {
    for (std::size_t i = 0; i < kBounds.size(); ++i) {
      EXPECT_FALSE(connects(dialer));
      EXPECT_LE(dialer.due() - now_, kBounds.at(i));
      now_ = dialer.due();
    }
  }

  std::string name_ = "@hc-dialer-" + std::to_string(::getpid());
  std::function<Status(int)> admit_;
  ListeningSocket listening_;
  TimePoint now_{seconds(1000)};
  std::vector<std::string> lines_;
};

TEST_F(DialerTest, ConnectsAtOnceWhereSomebodyListens) {
  listen();
  auto dialer = this->dialer();
  EXPECT_EQ(dialer.due(), now_);
  EXPECT_TRUE(connects(dialer));
  EXPECT_EQ(dialer.descriptor(), -1);
}

TEST_F(DialerTest, TriesNoSoonerThanItSays) {
  auto dialer = this->dialer();
  EXPECT_FALSE(connects(dialer));
  const auto due = dialer.due();
  ASSERT_GT(due, now_);
  listen();
  EXPECT_FALSE(connects(dialer));
  now_ = due - nanoseconds(1);
  EXPECT_FALSE(connects(dialer));
  now_ = due;
  EXPECT_TRUE(connects(dialer));
}

TEST_F(DialerTest, GivesUpWhenNobodyComesAndSaysWhy) {
  auto dialer = this->dialer(seconds(10), seconds(60));
  fail_until(dialer, now_ + seconds(10));
  EXPECT_EQ(dialer.dial(now_).error().text(), "NotFound: no peer for 10 s: Connection refused");
}

TEST_F(DialerTest, GivesUpWhenNobodyComesBack) {
  listen();
  auto dialer = this->dialer(seconds(60), seconds(10));
  EXPECT_TRUE(connects(dialer));
  lose(dialer);
  fail_until(dialer, now_ + seconds(10));
  EXPECT_EQ(dialer.dial(now_).error().text(), "Closed: no peer for 10 s: Connection refused");
}

TEST_F(DialerTest, LogsOnceThatItsFirstConnectionTakesLong) {
  auto dialer = this->dialer();
  log(dialer);
  const auto begin = now_;
  now_ = begin + Dialer::kQuiet - nanoseconds(1);
  EXPECT_FALSE(connects(dialer));
  EXPECT_TRUE(lines_.empty());
  for (int i : {1, 2}) {
    now_ = begin + i * Dialer::kQuiet;
    EXPECT_FALSE(connects(dialer));
    EXPECT_EQ(lines_,
              std::vector<std::string>{"no peer yet (Connection refused); giving up after 60 s"});
  }
  lines_.clear();
  auto patient = this->dialer(seconds(86'400));
  log(patient);
  now_ += Dialer::kQuiet;
  EXPECT_FALSE(connects(patient));
  EXPECT_EQ(lines_, std::vector<std::string>{"no peer yet (Connection refused); waiting"});
}

TEST_F(DialerTest, LogsALossUnlessAConnectionIsInUseBeforeThatIsDue) {
  listen();
  auto dialer = this->dialer();
  log(dialer);
  EXPECT_TRUE(connects(dialer));
  dialer.in_use();
  EXPECT_TRUE(lines_.empty());
  dialer.lost(now_, true, "sender closed", milliseconds(200));
  EXPECT_TRUE(connects(dialer));
  dialer.in_use();
  EXPECT_TRUE(lines_.empty());
  dialer.lost(now_, true, "reset");
  EXPECT_EQ(lines_, std::vector<std::string>{"reset; reconnecting"});
  EXPECT_TRUE(connects(dialer));
  dialer.in_use();
  EXPECT_EQ(lines_.back(), "reconnected");
  listening_ = {};
  dialer.lost(now_, true, "sender closed", milliseconds(200));
  EXPECT_FALSE(connects(dialer));
  EXPECT_EQ(lines_.size(), 2U);
  now_ += milliseconds(200);
  EXPECT_FALSE(connects(dialer));
  EXPECT_EQ(lines_.back(), "sender closed; reconnecting");
}

TEST_F(DialerTest, AfterAConnectionOfUseItTriesAtOnceAndWithShortPauses) {
  auto dialer = this->dialer();
  tire(dialer);
  listen();
  EXPECT_TRUE(connects(dialer));
  lose(dialer);
  EXPECT_EQ(dialer.due(), now_);
  tire(dialer);  // checks the bounds
}

TEST_F(DialerTest, AfterOneOfNoUseItGoesOnWithItsPausesUnlessItLived) {
  const auto longest_after = [&](nanoseconds life) {
    nanoseconds longest(0);
    for (int i = 0; i < 20; ++i) {
      auto dialer = this->dialer();
      tire(dialer);
      listen();
      EXPECT_TRUE(connects(dialer));
      now_ += life;
      lose(dialer, false);
      longest = std::max(longest, nanoseconds(dialer.due() - now_));
    }
    return longest;
  };
  const auto longest = longest_after(internal::kFirstPause - nanoseconds(1));
  EXPECT_LE(longest, internal::kLongestPause);
  EXPECT_GT(longest, 3 * internal::kFirstPause);
  EXPECT_LE(longest_after(internal::kFirstPause), internal::kFirstPause);
}

TEST_F(DialerTest, PatienceBeginsAnewWithEachLoss) {
  listen();
  auto dialer = this->dialer(seconds(10), seconds(10));
  EXPECT_TRUE(connects(dialer));
  now_ += seconds(100);
  lose(dialer);
  EXPECT_FALSE(connects(dialer));
  listen();
  now_ = dialer.due();
  EXPECT_TRUE(connects(dialer));
}

TEST_F(DialerTest, WhoIsOfNoUseIsTriedOnceMoreBeforeItIsGivenUp) {
  listen();
  auto dialer = this->dialer(seconds(1), seconds(1));
  EXPECT_TRUE(connects(dialer));
  for (int i = 0; i < 100; ++i) {  // the pauses become longer than the patience
    dialer.lost(now_, false, "it refuses us");
    now_ = dialer.due();
    ASSERT_TRUE(connects(dialer)) << i;
  }
}

TEST_F(DialerTest, WhoComesShortlyBeforeTheEndIsStillMet) {
  for (int i = 0; i < 30; ++i) {
    listening_ = {};
    auto dialer = this->dialer(seconds(2));
    const auto end = now_ + seconds(2);
    while (dialer.due() < end) {
      now_ = dialer.due();
      ASSERT_FALSE(connects(dialer));
    }
    listen();
    now_ = end;
    ASSERT_TRUE(connects(dialer)) << i;
  }
}

TEST_F(DialerTest, APeerThatIsNotWantedIsNoConnection) {
  listen();
  admit_ = [](int) { return Error{Code::System, "not of this user"}; };
  auto dialer = this->dialer(seconds(10));
  EXPECT_FALSE(connects(dialer));
  EXPECT_GT(dialer.due(), now_);  // after a pause
  EXPECT_EQ(dialer.descriptor(), -1);
  EXPECT_EQ(dialer.dial(now_ + seconds(10)).error().text(),
            "NotFound: no peer for 10 s: not of this user");
}

TEST_F(DialerTest, AllAddressesAreTriedBeforeAPause) {
  listen();
  auto here = internal::unix_peer(*parse_uri("unix:" + name_))->addresses;
  auto nobody = internal::unix_peer(*parse_uri("unix:" + name_ + "-nobody"))->addresses;
  Dialer dialer({{nobody[0], nobody[0], here[0]}, "peer", {}}, seconds(10), seconds(10), now_);
  for (int i = 0; i < 2; ++i) {
    EXPECT_FALSE(connects(dialer));
    EXPECT_EQ(dialer.due(), now_);
  }
  EXPECT_TRUE(connects(dialer));
}

TEST_F(DialerTest, ATryWithoutAnAnswerIsFollowedByTheNextAtOnce) {
  SilentPort silent;
  Dialer dialer({{loopback_address(silent.port())}, "peer", {}}, seconds(3), seconds(3), now_);
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(connects(dialer));
    EXPECT_GE(dialer.descriptor(), 0);
    EXPECT_EQ(dialer.due(), now_ + Dialer::kAnswer);
    EXPECT_FALSE(connects(dialer));  // is the same try still
    now_ = dialer.due();
  }
  EXPECT_EQ(dialer.dial(now_).error().text(), "NotFound: no peer for 3 s: Connection timed out");
}

}  // namespace
}  // namespace hc::testing
