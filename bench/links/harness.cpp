// SPDX-License-Identifier: Apache-2.0
#include "harness.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <sstream>
#include <thread>
#include <variant>
#include <vector>

#include "pattern.h"

namespace bench {
namespace {

constexpr double kWarmSeconds = 0.05;

double seconds_now() {
  using Seconds = std::chrono::duration<double>;
  return Seconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A counter that costs less than a clock, which a polled round of 0.3 µs would show.
std::uint64_t ticks() {
#ifdef __x86_64__
  return __builtin_ia32_rdtsc();
#else
  return static_cast<std::uint64_t>(seconds_now() * 1e9);
#endif
}

void pause() {
#ifdef __x86_64__
  __builtin_ia32_pause();
#endif
}

Setup parse(int argc, char** argv) {
  Setup setup;
  const std::map<std::string, std::variant<std::string*, int*, double*, std::size_t*>> fields = {
      {"role", &setup.role},     {"mode", &setup.mode},       {"link", &setup.link},
      {"folder", &setup.folder}, {"sink", &setup.sink},       {"source", &setup.source},
      {"port", &setup.port},     {"readers", &setup.readers}, {"reader", &setup.reader},
      {"rounds", &setup.rounds}, {"seconds", &setup.seconds}, {"bytes", &setup.bytes}};
  for (int i = 1; i < argc; ++i) {
    std::string argument = argv[i], key = argument.substr(0, argument.find('='));
    if (key.size() == argument.size()) fail("arguments are KEY=VALUE: " + argument);
    const auto field = fields.find(key);
    if (field == fields.end()) fail("no such argument: " + key);
    std::istringstream value(argument.substr(key.size() + 1));
    std::visit([&](auto* to) { value >> *to; }, field->second);
    if (!value) fail("no such value: " + argument);
  }
  return setup;
}

void say(const std::string& line) {
  std::puts(line.c_str());
  std::fflush(stdout);
}

/// Waits for a line on standard input; false when it has ended.
bool await_line() {
  char byte = 0;
  while (true) {
    ssize_t size = ::read(STDIN_FILENO, &byte, 1);
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return false;
    if (byte == '\n') return true;
  }
}

void expect_bytes(std::span<const std::byte> message, const Setup& setup) {
  // Our 96 bytes on the wire are a header and elements; of the latter there are fewer.
  if (message.size() < 8 || (message.size() != setup.bytes && setup.sink.empty()))
    fail("received " + std::to_string(message.size()) + " bytes");
}

void ping(const Setup& setup, Publisher& publisher, Subscriber& subscriber) {
  publisher.resend();
  expect_bytes(subscriber.receive(), setup);
  Rounds rounds(setup);
  do {
    publisher.resend();
    static_cast<void>(subscriber.receive());
  } while (rounds.next());
  say(rounds.json());
  if (await_line()) publisher.resend();  // pong knows by now that it is the last
}

void pong(Publisher& publisher, Subscriber& subscriber) {
  std::atomic<bool> is_last = false;
  std::thread listener([&] {
    await_line();
    is_last = true;
    say("{}");
  });
  while (true) {
    static_cast<void>(subscriber.receive());
    if (is_last.load(std::memory_order_relaxed)) break;
    publisher.resend();
  }
  listener.join();
}

void publish(const Setup& setup, Publisher& publisher) {
  const std::uint64_t look_every = setup.is_small() ? 64 : 1;
  const double end = seconds_now() + setup.seconds + 2 * kWarmSeconds;
  bool over = false;
  for (std::uint64_t number = 0; !over; ++number) {
    over = number % look_every == 0 && seconds_now() > end;
    auto room = publisher.loan();
    write_pattern(room.data(), room.size(), over ? kLast + number : number);
    publisher.publish();
  }
  say("{}");
}

void subscribe(const Setup& setup, Subscriber& subscriber) {
  const std::uint64_t look_every = setup.is_small() ? 64 : 1;
  std::uint64_t received = 0, next = 0, lost = 0, counted_from = 0, counted = 0;
  double first = 0, begin = 0, end = 0;
  for (bool over = false; !over;) {
    auto message = subscriber.receive();
    expect_bytes(message, setup);
    if (!read_pattern(message)) fail("received other bytes than were sent");
    std::uint64_t number = first_word(message);
    over = number >= kLast;
    if (over) number -= kLast;
    lost += number - next;
    next = number + 1;
    if (++received % look_every != 0) continue;
    double now = seconds_now();
    if (first == 0) first = now;
    if (now - first < kWarmSeconds) continue;
    if (begin == 0) {
      begin = now;
      counted_from = received;
    } else if (now - begin <= setup.seconds) {
      end = now;
      counted = received - counted_from;
    }
  }
  char line[200];
  std::snprintf(line, sizeof line, R"({"received": %llu, "lost": %llu, "per_second": %.3f})",
                static_cast<unsigned long long>(received), static_cast<unsigned long long>(lost),
                end > begin ? static_cast<double>(counted) / (end - begin) : 0.0);
  say(line);
}

}  // namespace

Rounds::Rounds(const Setup& setup)
    : limit_(static_cast<std::size_t>(setup.rounds)),
      look_every_(setup.is_small() ? 64 : 1),
      seconds_(setup.seconds),
      warm_end_(seconds_now() + kWarmSeconds),
      warm_left_(limit_ / 10) {
  rounds_.reserve(limit_);
}

bool Rounds::next() {
  // Of one stamp a round, so that nothing but the round is between two of them.
  const std::uint64_t now = ticks();
  if (warm_left_ > 0) {
    if (--warm_left_ > 0 && seconds_now() < warm_end_) return true;
    warm_left_ = 0;
    begin_ = seconds_now();
    begin_ticks_ = last_ = ticks();
    return true;
  }
  rounds_.push_back(now - last_);
  last_ = now;
  if (rounds_.size() < limit_ && rounds_.size() % look_every_ != 0) return true;
  const double passed = seconds_now() - begin_;
  last_ = ticks();
  nanoseconds_a_tick_ = passed * 1e9 / static_cast<double>(last_ - begin_ticks_);
  return rounds_.size() < limit_ && passed < seconds_;
}

std::string Rounds::json() {
  std::sort(rounds_.begin(), rounds_.end());
  auto half_trip = [&](double part) {  // [µs]
    auto at = static_cast<std::size_t>(part * static_cast<double>(rounds_.size() - 1));
    return static_cast<double>(rounds_[at]) * nanoseconds_a_tick_ / 2e3;
  };
  char line[200];
  std::snprintf(line, sizeof line, R"({"rounds": %zu, "median_us": %.4f, "p99_us": %.4f})",
                rounds_.size(), half_trip(0.5), half_trip(0.99));
  return line;
}

void fail(std::string_view what) {
  std::fprintf(stderr, "%.*s\n", static_cast<int>(what.size()), what.data());
  // Without destructors: those of a peer may wait for what does not come any more.
  std::_Exit(1);
}

int require(int result, std::string_view what) {
  if (result < 0) fail(std::string(what) + ": " + std::to_string(errno));
  return result;
}

void Spin::operator()() {
  constexpr int kTriesAlone = 2000;
  if (++tries_ < kTriesAlone)
    pause();
  else
    ::sched_yield();
}

int run(int argc, char** argv, MakePublisher make_publisher, MakeSubscriber make_subscriber) {
  const Setup setup = parse(argc, argv);
  // Ping's messages go over the link …_a, the answers over …_b and the next port.
  Setup to = setup, from = setup;
  (setup.role == "pong" ? to : from).link += "_b";
  (setup.role == "pong" ? from : to).link += "_a";
  (setup.role == "pong" ? to : from).port += 1;
  if (!setup.is_latency()) to = from = setup;

  std::unique_ptr<Publisher> publisher;
  std::unique_ptr<Subscriber> subscriber;
  if (setup.role != "subscribe") publisher = make_publisher(to);
  if (setup.role != "publish") subscriber = make_subscriber(from);
  if (publisher) publisher->await_readers();
  if (subscriber) subscriber->await_writer();
  say("ready");
  if (!await_line()) return 1;
  if (setup.role == "ping") {
    ping(setup, *publisher, *subscriber);
  } else if (setup.role == "pong") {
    pong(*publisher, *subscriber);
  } else if (setup.role == "publish") {
    publish(setup, *publisher);
  } else if (setup.role == "subscribe") {
    subscribe(setup, *subscriber);
  } else {
    fail("no such role: " + setup.role);
  }
  while (await_line()) {
  }
  return 0;
}

}  // namespace bench
