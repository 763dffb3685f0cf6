// SPDX-License-Identifier: Apache-2.0
#pragma once
// What the tests of running modules share: a module on a thread of its own, and what it is told and
// reports. Internal.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <hc/node/management.h>
#include <hc/node/module.h>
#include <hc/wire/rows.h>

namespace hc {

inline std::unique_ptr<Source> source_of(const std::string& uri) {
  auto source = open_source(*parse_uri(uri));
  EXPECT_TRUE(source) << uri;
  return std::move(*source);
}
inline std::unique_ptr<Sink> sink_of(const std::string& uri) {
  auto sink = open_sink(*parse_uri(uri));
  EXPECT_TRUE(sink) << uri;
  return std::move(*sink);
}

inline Message in_mode(Message message, std::int32_t mode) {
  message.header.mode = mode;
  return message;
}
inline Message to(Message message, std::int32_t dst) {
  message.header.dst = dst;
  return message;
}

/// A module that runs on a thread of its own, with links inside the process whose names begin with
/// the test's.
class RunningModule : public ::testing::Test {
 protected:
  std::string uri(const std::string& name) {
    return std::string("inproc:") +
           ::testing::UnitTest::GetInstance()->current_test_info()->name() + "-" + name;
  }
  void start(Module& module, std::vector<std::string> words) {
    thread_ = std::thread([this, &module, words = std::move(words)]() mutable {
      words.insert(words.begin(), "module");
      std::vector<char*> arguments;
      for (auto& word : words) arguments.push_back(word.data());
      status_ = module.run(static_cast<int>(arguments.size()), arguments.data());
    });
  }
  int join() {
    thread_.join();
    return status_;
  }

  std::thread thread_;
  int status_ = -1;
};

/// The next report of a kind.
inline Message next(Source& reports, internal::Report kind) {
  Message message;
  do {
    HC_CHECK(*receive(reports, message));
  } while (message.header.src != static_cast<int>(kind));
  return message;
}

inline Status tell(Sink& control, const std::string& line) {
  return control.send(make_rows(std::vector<std::string>{line}));
}

using Doubles = MessageOf<Kind<MatrixType::Table, double>>;

/// The numbers of the next counters; a row for each link.
inline std::vector<std::vector<std::int64_t>> next_counters(Source& reports) {
  std::vector<std::vector<std::int64_t>> rows;
  auto message = next(reports, internal::Report::Counters);
  auto view = *message.view<std::int64_t>();
  for (std::size_t i = 0; i < view.height(); ++i)
    rows.emplace_back(view.row(i).begin(), view.row(i).end());
  return rows;
}

}  // namespace hc
