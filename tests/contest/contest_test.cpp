// SPDX-License-Identifier: Apache-2.0
// The contest for the focus as it is run: the programs workspace and actor at work, each on a
// thread and over links. The test is what is around them: three sources that bid for three modes,
// as tasks and as persons, contradict each other, stop, guard, command and are silent at random,
// and the clock. Nothing waits for time; each step follows from the one before.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <condition_variable>
#include <future>
#include <mutex>
#include <random>
#include <thread>

#include <actor/program.h>
#include <hc/link/link.h>
#include <hc/module/kind.h>
#include <hc/mtp/rows.h>
#include <hc/os/program.h>
#include <workspace/program.h>
#include <workspace/workspace_conformance.h>

namespace {

using std::chrono::milliseconds;

constexpr unsigned kSequences = 2'000;
constexpr int kPeriods = 10;                      // of a sequence
constexpr milliseconds kPeriod{50};               // from one decision to the next
constexpr std::int32_t kModes = 3, kSources = 3;  // from 1 on

std::string uri(const std::string& name) {
  return "inproc:contest-" + name;
}
std::unique_ptr<hc::Source> source_of(const std::string& name) {
  return std::move(*hc::open_source(*hc::parse_uri(uri(name))));
}
std::unique_ptr<hc::Sink> sink_of(const std::string& name) {
  return std::move(*hc::open_sink(*hc::parse_uri(uri(name))));
}

/// A message that does something when the last who holds it lets go of it.
hc::Message at_last(hc::Message message, std::function<void()> act) {
  auto owner = std::move(message.owner);
  message.owner = {owner.get(), [owner, act = std::move(act)](const void*) { act(); }};
  return message;
}

/// A program on a thread of its own.
class Running {
 public:
  Running(std::function<int(int, char**)> program, std::vector<std::string> words)
      : words_(std::move(words)), thread_([this, program = std::move(program)] {
          std::vector<char*> arguments;
          for (auto& word : words_) arguments.push_back(word.data());
          status_ = program(static_cast<int>(arguments.size()), arguments.data());
        }) {}

  int join() {
    thread_.join();
    return status_;
  }

 private:
  std::vector<std::string> words_;
  int status_ = -1;
  std::thread thread_;
};

/// Where a thread is held up until another lets it continue.
class Gate {
 public:
  void pass() {
    std::unique_lock lock(mutex_);
    is_held_ = true;
    changed_.notify_all();
    changed_.wait(lock, [&] { return !is_held_ || is_removed_; });
  }
  void wait_until_held() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return is_held_; });
  }
  void open() {
    std::lock_guard lock(mutex_);
    is_held_ = false;
    changed_.notify_all();
  }
  void remove() {
    std::lock_guard lock(mutex_);
    is_removed_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_held_ = false, is_removed_ = false;
};

/// One random sequence of bids and commands, with what must hold at each period.
///
/// While bids are made and the focus is decided, the actor is held up: it lets go of a command, and
/// that takes until the gate is opened. So it has commands waiting whenever the focus changes.
class Contest {
 public:
  explicit Contest(unsigned seed)
      : random_(seed), options_(pick_options()), rules_(options_), due_(clock_.monotonic()) {
    start_workspace();
    command_in_each_mode();
    actor_.emplace(
        [this](int argc, char** argv) { return run_actor(argc, argv, clock_); },
        std::vector<std::string>{"actor", "--exclusive=command", "--in=command=" + uri("command"),
                                 "--in=focus=" + uri("focus-actor"), "--out=done=" + uri("done")});
    gate_.wait_until_held();
    check_actor();
  }

  ~Contest() {
    gate_.remove();
    for (auto& link : bids_) link.reset();
    person_.reset();
    stop_.reset();
    command_.reset();
    EXPECT_EQ(workspace_->join(), 0);
    EXPECT_EQ(actor_->join(), 0);
  }
  Contest(const Contest&) = delete;
  Contest& operator=(const Contest&) = delete;

  void run() {
    for (int period = 0; period < kPeriods; ++period) {
      for (int bids = pick(0, 4); bids > 0; --bids) bid();
      command_in_each_mode(false);
      decide();
      command_in_each_mode();
      gate_.open();
      gate_.wait_until_held();
      check_actor();
    }
  }

 private:
  int pick(int least, int most) { return std::uniform_int_distribution(least, most)(random_); }

  WorkspaceOptions pick_options() {
    const milliseconds step{125};  // a number of seconds that is exact, in decimal and in binary
    return {pick(0, 4) * 5 / 100.0, step * pick(0, 4), step * pick(1, 5), step * pick(1, 3)};
  }
  static std::string in_seconds(std::chrono::nanoseconds time) {
    return std::to_string(std::chrono::duration<double>(time).count());
  }

  void start_workspace() {
    std::vector<std::string> words{
        "workspace", "--rate=" + std::to_string(milliseconds(1000) / kPeriod),
        "--margin=" + std::to_string(options_.margin), "--dwell=" + in_seconds(options_.dwell),
        "--expiry=" + in_seconds(options_.expiry),
        "--person_expiry=" + in_seconds(options_.person_expiry), "--control=" + uri("control"),
        "--in=person=" + uri("person"), "--in=stop=" + uri("stop"),
        // In this order: what the test has learned of has reached the actor.
        "--out=focus=" + uri("focus-actor?keep=latest"), "--out=focus=" + uri("focus-test")};
    for (std::size_t i = 0; i < bids_.size(); ++i) {
      const std::string name = "bids-" + std::to_string(i);
      bids_[i] = sink_of(name);
      words.push_back("--in=bids=" + uri(name));
    }
    workspace_.emplace([this](int argc, char** argv) { return run_workspace(argc, argv, clock_); },
                       words);
    // Changes nothing; once it is taken, the first decision has its time.
    say(*bids_[0], {1, 1}, hc::table().message({0.0}));
  }

  /// Says something as a source, and waits until the workspace has taken it.
  void say(hc::Sink& link, const Bidder& who, hc::Message message) {
    auto taken = std::make_shared<std::promise<void>>();
    message.header.mode = who.mode;
    message.header.src = who.source;
    EXPECT_TRUE(link.send(at_last(std::move(message), [taken] { taken->set_value(); })));
    taken->get_future().wait();
  }

  void bid() {
    clock_.advance(milliseconds(pick(0, 12)));  // four of these are less than a period
    const auto now = clock_.monotonic();
    const Bidder who{pick(1, kModes), pick(1, kSources)};
    // Few numbers, so that there are equal ones.
    const double salience = pick(0, 4) == 0 ? 0 : 0.1 * pick(1, 10);
    auto& link = *bids_.at(static_cast<std::size_t>(who.source - 1));
    const int what = pick(0, 9);
    if (what < 3) {
      say(*person_, who, hc::table().message({salience}));
      rules_.bid_of_person(who, salience, now);
    } else if (what == 3) {  // of another time: it changes nothing
      auto message = hc::table().message({salience});
      message.header.time = clock_.wall() + (pick(0, 1) == 0 ? 1 : -1) * std::chrono::hours(1);
      say(link, who, message);
    } else if (what == 4) {
      const auto word = static_cast<std::uint8_t>(
          std::array{0, 0, 0, 1, 2, 2, 3}.at(static_cast<std::size_t>(pick(0, 6))));
      say(*stop_, who, hc::table<std::uint8_t>().message({word}));
      rules_.stop({who.source, word, 0, now}, now);
    } else {
      say(link, who, hc::table().message({salience}));
      rules_.bid(who, salience, now);
    }
  }

  /// Has a command of each task wait for the actor; the last one may hold it up. That works as the
  /// actor is held up now, or not at work yet, and so will be the last to let go of the message.
  void command_in_each_mode(bool last_holds = true) {
    std::array<std::int32_t, kModes> modes{1, 2, 3};
    std::shuffle(modes.begin(), modes.end(), random_);
    for (auto mode : modes) {
      offered_.push_back(mode);
      hc::Message message = hc::table().message({0.0});
      message.header.mode = mode;
      message.header.time = hc::unix_time(std::ssize(offered_));  // the actor reports it too
      if (last_holds && mode == modes.back())
        message = at_last(std::move(message), [this] { gate_.pass(); });
      EXPECT_TRUE(command_->send(message));
    }
  }

  void decide() {
    due_ += kPeriod;
    clock_.advance(due_ - clock_.monotonic());
    EXPECT_TRUE(control_->send(hc::make_rows(std::vector<std::string>{""})));  // wakes it
    hc::Message got;
    ASSERT_TRUE(*hc::receive(*reported_, got));
    focus_ = hc::view<std::int32_t>(got)->at(0, 0);
    rules_.decided(focus_, clock_.monotonic());
  }

  /// Of the commands that were offered before the last decision and behind it, the actor has
  /// handled those of the mode that the workspace granted, in their order, and no others.
  void check_actor() {
    std::vector<std::size_t> in_focus, handled;
    for (; checked_ < offered_.size(); ++checked_)
      if (offered_[checked_] == focus_) in_focus.push_back(checked_);
    hc::Message done;
    while (*done_->take(done) == hc::Got::Message) {
      handled.push_back(static_cast<std::size_t>(hc::unix_nanoseconds(done.header.time) - 1));
      const auto mode = offered_.at(handled.back());
      EXPECT_EQ(mode, focus_) << "the actor got a command out of focus";
    }
    EXPECT_EQ(handled, in_focus) << "commands handled, and those in focus";
  }

  std::minstd_rand random_;
  WorkspaceOptions options_;
  FocusRules rules_;
  hc::ManualClock clock_;
  hc::MonotonicTime due_;              // of the last decision
  std::int32_t focus_ = 0;             // of the workspace
  std::vector<std::int32_t> offered_;  // modes of the commands, by their numbers
  std::size_t checked_ = 0;            // of these
  Gate gate_;

  std::array<std::unique_ptr<hc::Sink>, kSources> bids_;
  std::unique_ptr<hc::Sink> person_ = sink_of("person"), stop_ = sink_of("stop"),
                            command_ = sink_of("command"), control_ = sink_of("control");
  std::unique_ptr<hc::Source> reported_ = source_of("focus-test"), done_ = source_of("done");
  std::optional<Running> workspace_, actor_;
};

TEST(Contest, in_random_sequences_the_actor_follows_the_focus) {
  for (unsigned seed = 1; seed <= kSequences; ++seed) {
    SCOPED_TRACE(seed);
    Contest(seed).run();
    ASSERT_FALSE(testing::Test::HasFailure());
  }
}

}  // namespace
