// SPDX-License-Identifier: Apache-2.0
#pragma once
// For tests: a conversation with a simulated unit over a faulty line.

#include <drivers/pan_tilt/conversation.h>

#include <gtest/gtest.h>

#include <deque>
#include <random>
#include <string>
#include <utility>
#include <vector>

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
  double bytes_per_second = 0;  // 0: at once
  bool is_silent = false;
  bool is_read = true;  // else the host's answers wait to be read
  double garbage = 0;
  bool looks = true;
  std::string asked;  // all that the host wrote
  std::vector<Gaze> gazes;
  std::vector<std::string> faults, remarks;
  std::deque<std::pair<MonotonicTime, char>> going, coming;
  MonotonicTime going_at{0}, coming_at{0};  // arrival of the last byte
  std::mt19937 random{1};

  /// The arrival time of a byte queued now.
  MonotonicTime after(MonotonicTime& last, MonotonicTime put) const {
    last = std::max(last, put);
    if (bytes_per_second > 0)
      last += std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 / bytes_per_second));
    return last;
  }
  void exchange() {
    const std::string written = host.bytes(now);
    asked += written;
    for (char byte : written) going.emplace_back(after(going_at, now), byte);
    std::string bytes;
    for (; !going.empty() && going.front().first <= now; going.pop_front())
      bytes += going.front().second;
    const double time = seconds();
    for (char byte : unit.take(time, bytes) + unit.pass(time)) {
      if (is_silent) continue;
      const bool is_corrupted = static_cast<double>(random() % 1000) < garbage * 1000;
      coming.emplace_back(after(coming_at, now + delay),
                          is_corrupted ? static_cast<char>(random() % 256) : byte);
    }
  }
  void step() {
    exchange();
    now += milliseconds(1);
    std::string come;
    for (; is_read && !coming.empty() && coming.front().first <= now; coming.pop_front())
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
  void begin(milliseconds within = milliseconds(300)) {
    host.begin(now);
    run(within);
    ASSERT_EQ(host.phase(), Phase::Ready);
  }
  void begin_slowly() {
    delay = milliseconds(0);
    bytes_per_second = 960;
    host.set_line(960);
    begin(milliseconds(2000));
  }
  double seconds() const { return std::chrono::duration<double>(now).count(); }
  /// The host's commands since the last call, without queries.
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

/// Repairs the line and checks that the host's state is correct.
inline void check_recovery(Line& line) {
  line.delay = milliseconds(2);
  line.garbage = 0;
  for (int i = 0; i < 10'000 && line.host.phase() != Phase::Ready; ++i) {
    if (line.host.phase() == Phase::Lost) line.host.begin(line.now);
    line.step();
  }
  line.run(milliseconds(2000));
  ASSERT_EQ(line.host.phase(), Phase::Ready);
  EXPECT_EQ(line.host.character(),
            "pan from -158.9 to 158.9, tilt from -31.1 (up) to 46.6 (down) degrees");
  const double time = line.seconds();
  EXPECT_NEAR(line.gazes.back().pan, line.unit.pan(time) * kStep, kStep);
  EXPECT_NEAR(line.gazes.back().tilt, -line.unit.tilt(time) * kStep, kStep);
}

}  // namespace hc::pan_tilt
