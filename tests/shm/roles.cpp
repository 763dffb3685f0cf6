// SPDX-License-Identifier: Apache-2.0
#include "roles.h"

#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <deque>
#include <iostream>
#include <random>
#include <stdexcept>
#include <vector>

#include "checked_message.h"
#include "child.h"

namespace hc::testing {
namespace {

struct Failed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

LinkOptions options() {
  LinkOptions options;
  options.stop = Child::kSocket;
  return options;
}

std::int64_t now() {
  return std::chrono::steady_clock::now().time_since_epoch().count();
}

bool is_spoken_to() {
  pollfd polled{Child::kSocket, POLLIN, 0};
  return ::poll(&polled, 1, 0) > 0;
}

/// Empty, inside a cell, just beside it, of a page, and images; the large ones are rare.
std::int32_t mixed_size(std::mt19937& random) {
  auto dice = random() % 100;
  if (dice < 10) return 0;
  if (dice < 45) return 24;
  if (dice < 60) return static_cast<std::int32_t>(100 + random() % 150);
  if (dice < 75) return 300;
  if (dice < 90) return 4096;
  return dice < 98 ? 100'000 : 1'440'000;
}

int publish(const std::string& uri, std::int32_t id, std::int64_t count, const std::string& bytes) {
  auto sink = open_sink(*parse_uri(uri), options());
  if (!sink) throw Failed(sink.error().text());
  std::mt19937 random(static_cast<unsigned>(id));
  std::int64_t seq = 0;
  while ((count == 0 || seq < count) && !is_spoken_to()) {
    auto size = bytes == "mixed" ? mixed_size(random) : std::stoi(bytes);
    auto message = make_checked(seq % 2 == 0 ? sink->get() : nullptr, id, seq, size);
    auto sent = (*sink)->send(message);
    if (!sent && sent.error().code == Code::Stopped) break;
    if (!sent) throw Failed(sent.error().text());
    ++seq;
  }
  if (auto closed = (*sink)->close(); !closed) throw Failed(closed.error().text());
  report("sent " + std::to_string(seq));
  return 0;
}

class Reader {
 public:
  Reader(std::string uri, bool gapless, std::size_t most)
      : uri_(std::move(uri)), gapless_(gapless), most_(most) {}

  int run() {
    while (open()) {
      while (take()) {
      }
      while (!held_.empty()) let_go();
      if (ended_) break;
      auto traffic = source_->traffic();
      report("end " + std::to_string(traffic.messages) + " " + std::to_string(traffic.lost()) +
             " " + std::to_string(last_));
    }
    return 0;
  }

 private:
  bool open() {
    source_.reset();
    while (true) {
      listen();
      if (ended_) return false;
      auto source = open_source(*parse_uri(uri_), options());
      if (source) {
        source_ = std::move(*source);
        last_ = -1;
        return true;
      }
      // A publisher may die before it has answered.
      auto code = source.error().code;
      if (code != Code::Closed && code != Code::Stopped) throw Failed(source.error().text());
    }
  }

  /// Takes and checks one; false when there is none any more.
  bool take() {
    listen();
    if (ended_) return false;
    Message message;
    auto got = receive(*source_, message, Child::kSocket);
    if (!got && got.error().code == Code::Stopped) return true;
    if (!got && got.error().code == Code::Closed) return false;  // it has died
    if (!got) throw Failed(got.error().text());
    if (!*got) return false;
    check(message);
    auto place = place_of(message.header);
    bool follows = gapless_ ? place == last_ + 1 : place > last_;
    if (last_ >= 0 && !follows)
      throw Failed(std::to_string(place) + " behind " + std::to_string(last_));
    last_ = place;
    if (asked_ >= 0 && place > asked_) {
      asked_ = -1;
      report(std::to_string(place) + " " + std::to_string(now()));
    }
    if (most_ == 0) return true;
    held_.push_back(std::move(message));
    for (auto hold = random_() % (most_ + 1); held_.size() > hold;) let_go();
    return true;
  }

  void let_go() {
    check(held_.front());
    held_.pop_front();
  }

  void check(const Message& message) const {
    if (!is_whole(message))
      throw Failed("not whole: " + text(message.header) + " behind " + std::to_string(last_));
  }

  void listen() {
    if (!is_spoken_to()) return;
    for (auto line = command(ended_); !line.empty(); line = command(ended_))
      asked_ = std::stoll(line.substr(line.find(' ')));
  }

  std::string uri_;
  bool gapless_;
  std::size_t most_;
  std::unique_ptr<Source> source_;
  std::deque<Message> held_;
  std::mt19937 random_{static_cast<unsigned>(::getpid())};
  std::int64_t last_ = -1, asked_ = -1;
  bool ended_ = false;
};

int hold(const std::string& uri, std::size_t count) {
  auto source = open_source(*parse_uri(uri), options());
  if (!source) throw Failed(source.error().text());
  std::vector<Message> held(count);
  for (auto& message : held) {
    auto got = receive(**source, message, Child::kSocket);
    if (!got || !*got) throw Failed(got ? "ended" : got.error().text());
  }
  report("holds " + std::to_string(place_of(held.back().header)));
  for (bool ended = false; !ended;) {
    pollfd polled{Child::kSocket, POLLIN, 0};
    ::poll(&polled, 1, -1);
    command(ended);
  }
  for (const auto& message : held)
    if (!is_whole(message)) throw Failed("not whole: " + text(message.header));
  return 0;
}

}  // namespace

int run_role(std::span<char* const> arguments) try {
  std::vector<std::string> words(arguments.begin(), arguments.end());
  if (words.size() == 6 && words[1] == "publisher")
    return publish(words[2], std::stoi(words[3]), std::stoll(words[4]), words[5]);
  if (words.size() == 5 && words[1] == "reader")
    return Reader(words[2], words[3] == "gapless", std::stoul(words[4])).run();
  if (words.size() == 4 && words[1] == "holder") return hold(words[2], std::stoul(words[3]));
  return -1;
} catch (const Failed& failed) {
  std::cerr << arguments[1] << ": " << failed.what() << std::endl;
  return 3;
}

}  // namespace hc::testing
