// SPDX-License-Identifier: Apache-2.0
#pragma once
// The line between a host and a simulated unit, for tests of conversations: by a clock of its own.

#include <gtest/gtest.h>

#include <deque>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <drivers/pan_tilt/conversation.h>
#include <drivers/pan_tilt/unit.h>

namespace hc::pan_tilt {

using std::chrono::milliseconds;
using Phase = Conversation::Phase;

inline constexpr double kStep = kArcsecondsPerPosition / 3600 * 3.14159265358979 / 180;  // [rad]

/// A host and a simulated unit with a line between them that can be late, cut or bad.
struct Line {
  Unit unit;
  Conversation host;
  MonotonicTime now = milliseconds(1000);
  milliseconds delay{2};
  bool is_silent = false;
  double garbage = 0;
  bool looks = true;
  std::string asked;  // all that the host wrote
  std::vector<Gaze> gazes;
  std::vector<std::string> faults, remarks;
  std::deque<std::pair<MonotonicTime, char>> coming;
  std::mt19937 random{1};

  void exchange() {
    const std::string bytes = host.bytes();
    asked += bytes;
    const double time = std::chrono::duration<double>(now).count();
    for (char byte : unit.take(time, bytes) + unit.pass(time)) {
      if (is_silent) continue;
      const bool is_spoilt = static_cast<double>(random() % 1000) < garbage * 1000;
      coming.emplace_back(now + delay, is_spoilt ? static_cast<char>(random() % 256) : byte);
    }
  }
  void step() {
    exchange();
    now += milliseconds(1);
    std::string come;
    for (; !coming.empty() && coming.front().first <= now; coming.pop_front())
      come += coming.front().second;
    host.take(now, come);
    host.pass(now);
    if (auto gaze = host.gaze()) gazes.push_back(*gaze);
    if (auto fault = host.fault()) faults.push_back(fault->detail);
    if (auto remark = host.remark(); !remark.empty()) remarks.push_back(remark);
    if (looks && now.count() % 20'000'000 == 0) host.look(now);
  }
  void run(milliseconds duration) {
    for (const auto end = now + duration; now < end;) step();
  }
  void begin() {
    host.begin(now);
    run(milliseconds(300));
    ASSERT_EQ(host.phase(), Phase::Ready);
  }
  /// What the host wrote since the last time, without questions.
  std::string commands() {
    std::string all = std::exchange(asked, {}), left;
    for (std::size_t at = 0; at < all.size();) {
      const auto end = all.find(' ', at) + 1;
      const std::string one = all.substr(at, end - at);
      if (one != "pp " && one != "tp ") left += one;
      at = end;
    }
    return left;
  }
};

/// A conversation that has begun; what was written for that counts no more.
class Conversing : public testing::Test {
 protected:
  void SetUp() override {
    line.begin();
    line.commands();
  }
  Line line;
};

}  // namespace hc::pan_tilt
