// SPDX-License-Identifier: Apache-2.0
#pragma once
// What the tests of running modules share: a module on a thread of its own, and what it is asked
// and reports. Internal.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <hc/module/management.h>
#include <hc/module/module.h>
#include <hc/mtp/rows.h>
#include <hc/testing/next.h>

namespace hc {

/// Runs a module on this thread.
inline int run(Module& module, std::vector<std::string> words) {
  words.insert(words.begin(), "module");
  std::vector<char*> arguments;
  arguments.reserve(words.size());
  for (auto& word : words) arguments.push_back(word.data());
  return module.run(static_cast<int>(arguments.size()), arguments.data());
}

using Doubles = MessageOf<Kind<MatrixType::Table, double>>;

/// A module that takes numbers.
struct Taker : Module {
  explicit Taker(const std::string& name = "sink") : Module(name, "Takes.") {
    on(in, [](const auto&) {});
  }
  Input<Kind<MatrixType::Table, double>> in = input("in", table(), "");
};

/// A module that sends on the numbers that it takes.
struct Relay : Module {
  explicit Relay(const std::string& name = "relay") : Module(name, "Sends on.") {
    on(in, [this](const Doubles& m) { out.send({m.matrix().at(0, 0)}); });
  }
  Input<Kind<MatrixType::Table, double>> in = input("in", table(), "");
  Output<Kind<MatrixType::Table, double>> out = output("out", table(), "");
};

inline Message in_mode(Message message, std::int32_t mode) {
  message.header.mode = mode;
  return message;
}
inline Message to(Message message, std::int32_t dst) {
  message.header.dst = dst;
  return message;
}

/// The next report of a kind.
inline Message next(Source& reports, Report kind) {
  Message message;
  do {
    HC_CHECK(*receive(reports, message));
  } while (message.header.src != static_cast<int>(kind));
  return message;
}

inline Status send_command(Sink& control, const std::string& line) {
  return control.send(make_rows(std::vector<std::string>{line}));
}

/// A module that runs on a thread of its own, with links inside the process whose names begin with
/// the test's.
class RunningModule : public ::testing::Test {
 protected:
  std::string uri(const std::string& name) {
    return std::string("inproc:") +
           ::testing::UnitTest::GetInstance()->current_test_info()->name() + "-" + name;
  }
  void start(Module& module, const std::vector<std::string>& words) {
    thread_ = std::thread([this, &module, words] { status_ = hc::run(module, words); });
  }
  /// The same for one that reports and takes commands.
  void start_managed(Module& module, std::vector<std::string> words = {}) {
    control_ = sink_of(uri("control"));
    reports_ = source_of(uri("reports"));
    words.insert(words.end(), {"--manage=" + uri("reports"), "--control=" + uri("control")});
    start(module, words);
  }
  int join() {
    thread_.join();
    return status_;
  }
  /// Sends a command to a managed module.
  void command(const std::string& line) const { must(send_command(*control_, line)); }
  /// Its links, when they have changed the next time.
  [[nodiscard]] std::vector<std::string> next_links() const {
    return rows_of(next(*reports_, Report::Links));
  }
  /// The same for a command that changes them.
  std::vector<std::string> relink(const std::string& line) const {
    command(line);
    return next_links();
  }
  /// Ends a managed module that has no other link.
  void end() {
    must(control_->close());
    EXPECT_EQ(join(), 0);
  }

  std::unique_ptr<Sink> control_;
  std::unique_ptr<Source> reports_;
  std::thread thread_;
  int status_ = -1;
};

/// The number of a table that has one.
inline double number_of(const Message& message) {
  return view<double>(message)->at(0, 0);
}

/// Numbers of counters; a row for each link.
using CounterRows = std::vector<std::vector<std::int64_t>>;

inline CounterRows counters_of(const Message& message) {
  CounterRows rows;
  auto matrix = *view<std::int64_t>(message);
  for (std::size_t i = 0; i < matrix.height(); ++i)
    rows.emplace_back(matrix.row(i).begin(), matrix.row(i).end());
  return rows;
}
inline CounterRows next_counters(Source& reports) {
  return counters_of(next(reports, Report::Counters));
}
/// The last of a module that has ended.
inline CounterRows last_counters(Source& reports) {
  Message message, last;
  while (*reports.take(message) == Got::Message)
    if (message.header.src == static_cast<int>(Report::Counters)) last = message;
  return counters_of(last);
}

}  // namespace hc
