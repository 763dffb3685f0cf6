// SPDX-License-Identifier: Apache-2.0
// Ends of `shm:NAME` that are killed, at random moments and at each crash point: what others get is
// whole and right, they continue, and nothing is left behind. In full, for some minutes:
//
//     HC_SHM_KILLS=1000 HC_SHM_POINT_KILLS=20 build/tests/unit/shm_test
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>
#include <set>
#include <thread>

#include <hc/link/shm/layout.h>

#include "child.h"

namespace hc::testing {
namespace {

namespace fs = std::filesystem;

int count_of(const char* variable, int default_value) {
  const char* text = std::getenv(variable);
  return text == nullptr ? default_value : std::atoi(text);
}
int random_kills() {
  return count_of("HC_SHM_KILLS", 60);
}
int point_kills() {
  return count_of("HC_SHM_POINT_KILLS", 2);
}

/// A crash point, and how often a process comes by at least: it is to die at any of these times.
struct Point {
  const char* name;
  int times;
};

void PrintTo(const Point& point, std::ostream* out) {
  *out << point.name;
}

constexpr std::array<Point, 10> kReaderPoints = {{{"reader made page", 1},
                                                  {"reader greeted", 1},
                                                  {"reader has memory", 1},
                                                  {"reader copied", 300},
                                                  {"reader holds", 300},
                                                  {"reader took", 300},
                                                  {"reader let go", 100},
                                                  {"reader woke publisher", 5},
                                                  {"reader armed", 5},
                                                  {"reader left", 1}}};
constexpr std::array<Point, 14> kPublisherPoints = {{{"publisher greeted", 2},
                                                     {"publisher knows reader", 2},
                                                     {"publisher answered", 2},
                                                     {"publisher waits for room", 3},
                                                     {"publisher withdrew", 20},
                                                     {"publisher swept", 20},
                                                     {"publisher has slot", 100},
                                                     {"publisher filled slot", 100},
                                                     {"publisher wrote cell", 1000},
                                                     {"publisher stamped", 1000},
                                                     {"publisher published", 1000},
                                                     {"publisher woke readers", 1000},
                                                     {"publisher loaned", 100},
                                                     {"publisher closed", 1}}};

/// What the host has of shared memory.
struct Host {
  std::set<fs::path> files;
  std::int64_t kibibytes = 0;

  static Host now() {
    Host host;
    for (const auto& entry : fs::directory_iterator("/dev/shm")) host.files.insert(entry.path());
    std::ifstream memory("/proc/meminfo");
    for (std::string word; memory >> word;)
      if (word == "Shmem:") memory >> host.kibibytes;
    return host;
  }
  /// Others use it too: some more is nobody's fault, and what is much more may go yet.
  [[nodiscard]] bool is_as_before() const {
    constexpr std::int64_t kSlack = 16 << 10;
    Host host = now();
    return host.kibibytes <= kibibytes + kSlack &&
           std::includes(files.begin(), files.end(), host.files.begin(), host.files.end());
  }
};

class ShmCrash : public ::testing::TestWithParam<Point> {
 protected:
  void TearDown() override {
    publisher_ = Child();
    steady_ = Child();
    latest_ = Child();
    while (!host_.is_as_before()) std::this_thread::yield();
  }

  Child make_publisher(const std::string& options, const std::string& crash_at = "", int count = 0,
                       const std::string& bytes = "mixed") {
    return Child(
        {"publisher", name_ + "?" + options, std::to_string(++id_), std::to_string(count), bytes},
        crash_at);
  }
  /// @param hold  messages at most.
  Child make_reader(const std::string& kind, int hold, const std::string& crash_at = "") {
    auto keep = kind == "newest" ? "&keep=latest" : "&keep=all";
    return Child({"reader", name_ + "?wait=20" + keep, kind, std::to_string(hold)}, crash_at);
  }
  void make_readers() {
    steady_ = make_reader("gapless", 4);
    latest_ = make_reader("newest", 3);
  }

  /// Both readers get messages that were sent from now on.
  void expect_to_continue() {
    for (Child* reader : {&steady_, &latest_}) reader->first_behind(reader->first_behind(0) + 100);
  }
  void expect_the_next_to_be_heard() {
    publisher_ = make_publisher("readers=2");
    for (Child* reader : {&steady_, &latest_}) reader->first_behind(std::int64_t{id_} << 40);
    expect_a_good_end();
  }
  /// The publisher ends well, and both readers then have all that they should.
  void expect_a_good_end() {
    auto sent = publisher_.finish();
    ASSERT_TRUE(sent.starts_with("sent ")) << sent;
    auto count = std::stoll(sent.substr(5));
    for (Child* reader : {&steady_, &latest_}) {
      std::string line = reader->line();
      std::int64_t received = 0, dropped_newer = 0, last = 0;
      ASSERT_EQ(std::sscanf(line.c_str(), "end %ld %ld %ld", &received, &dropped_newer, &last), 3)
          << line;
      EXPECT_EQ(received + dropped_newer, count);
      EXPECT_TRUE(dropped_newer == 0 || reader == &latest_);
      EXPECT_EQ(last, std::int64_t{id_} << 40 | (count - 1));
      reader->finish();
    }
  }
  std::int64_t below(std::int64_t end) {
    return static_cast<std::int64_t>(random_() % static_cast<std::uint64_t>(end));
  }
  std::string crash_at(const Point& point) {
    return std::string(point.name) + ":" + std::to_string(1 + below(point.times));
  }

  const std::string name_ = "shm:crash-" + std::to_string(::getpid());
  const Host host_ = Host::now();
  std::mt19937 random_{42};
  int id_ = 0;
  Child publisher_, steady_, latest_;
};

void expect_killed(Child& child) {
  int status = child.wait();
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) << status;
}

TEST_F(ShmCrash, ReadersAreKilledAtRandomMoments) {
  publisher_ = make_publisher("readers=2");
  make_readers();
  expect_to_continue();
  const auto memories = publisher_.shared_memories(), descriptors = publisher_.descriptors();
  for (int i = 0; i < random_kills(); ++i) {
    auto victim = make_reader(i % 3 == 0 ? "newest" : "gapless", 10);
    if (i % 2 == 0) victim.first_behind(0);
    victim.look(below(20'000));
    victim.kill();
    expect_to_continue();
  }
  while (publisher_.shared_memories() != memories || publisher_.descriptors() != descriptors)
    expect_to_continue();
  expect_a_good_end();
}

TEST_F(ShmCrash, PublishersAreKilledAtRandomMoments) {
  make_readers();
  for (int i = 0; i < random_kills(); ++i) {
    publisher_ = make_publisher("readers=2");  // the name is free at once
    if (i % 2 == 0)
      for (Child* reader : {&steady_, &latest_}) reader->first_behind(std::int64_t{id_} << 40);
    publisher_.look(below(20'000));
    publisher_.kill();
  }
  expect_the_next_to_be_heard();
}

/// A publisher that cannot continue as a reader holds all of its memory continues when that reader
/// dies.
TEST_F(ShmCrash, SlotsComeBack) {
  constexpr auto kSlots = ((2 << 20) - internal::kSlotsBegin) / 100'032;  // of 100,000 bytes
  publisher_ = make_publisher("readers=1&memory=2M", "", 0, "100000");
  steady_ = make_reader("gapless", 0);
  steady_.first_behind(0);
  std::int64_t longest = 0;
  for (int i = 0; i < random_kills() / 3; ++i) {
    Child victim(
        {"holder", name_ + "?keep=" + (i % 2 == 0 ? "all" : "64"), std::to_string(kSlots)});
    auto line = victim.line();
    ASSERT_TRUE(line.starts_with("holds ")) << line;
    auto killed = std::chrono::steady_clock::now().time_since_epoch().count();
    victim.signal(SIGKILL);
    steady_.say("after " + line.substr(6));
    auto answer = steady_.line();
    ASSERT_NE(answer.find(' '), std::string::npos) << answer;
    auto went_on = std::stoll(answer.substr(answer.find(' ')));
    longest = std::max<std::int64_t>(longest, went_on - killed);
  }
  std::cout << "slots came back after at most " << longest / 1000 << " us\n";
  publisher_.finish();
  steady_.finish();
}

class ShmReaderCrash : public ShmCrash {};

TEST_P(ShmReaderCrash, OthersGoOn) {
  // One that runs out of room, if only that is what readers wake it for.
  publisher_ = std::string_view(GetParam().name) == "reader woke publisher"
                   ? make_publisher("readers=2&memory=3M", "", 0, "100000")
                   : make_publisher("readers=2");
  make_readers();
  expect_to_continue();
  for (int i = 0; i < point_kills(); ++i) {
    auto victim = make_reader("gapless", 10, crash_at(GetParam()));
    if (std::string_view(GetParam().name) == "reader left") {
      victim.first_behind(0);
      victim.stop();
    }
    expect_killed(victim);
    expect_to_continue();
  }
  expect_a_good_end();
}

class ShmPublisherCrash : public ShmCrash {};

TEST_P(ShmPublisherCrash, ReadersEndAndOpenTheNext) {
  const std::string_view point = GetParam().name;
  make_readers();
  for (int i = 0; i < point_kills(); ++i) {
    auto at = crash_at(GetParam());
    auto victim = point == "publisher closed" ? make_publisher("readers=2", at, 100)
                  : point == "publisher waits for room"  // there is room for one message
                      ? make_publisher("readers=2&memory=2M", at, 0, "1440000")
                      : make_publisher("readers=2", at);
    expect_killed(victim);
  }
  expect_the_next_to_be_heard();
}

std::string name_of(const ::testing::TestParamInfo<Point>& test) {
  std::string name = test.param.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(Points, ShmReaderCrash, ::testing::ValuesIn(kReaderPoints), name_of);
INSTANTIATE_TEST_SUITE_P(Points, ShmPublisherCrash, ::testing::ValuesIn(kPublisherPoints), name_of);

/// Else a point would be added that no test dies at.
TEST(ShmCrashPoints, EachHasItsTest) {
  std::set<std::string> tested, found;
  for (const auto& point : kReaderPoints) tested.insert(point.name);
  for (const auto& point : kPublisherPoints) tested.insert(point.name);
  const std::string call = "HC_CRASH_POINT(\"";
  for (const auto& entry : fs::directory_iterator(fs::path(HC_SOURCE_DIR) / "lib/hc/link/shm")) {
    if (entry.path().filename() == "crash_point.h") continue;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);)
      if (auto at = line.find(call); at != std::string::npos)
        found.insert(line.substr(at + call.size(), line.rfind('"') - at - call.size()));
  }
  EXPECT_EQ(found, tested);
}

}  // namespace
}  // namespace hc::testing
