// SPDX-License-Identifier: Apache-2.0
#pragma once
// What every transport, peer and floor is measured with. Each is a program of its own that derives
// a Publisher and a Subscriber and hands them to run(); clocks, patterns, checks and reports are
// here, so they are the same for all. Failures end the program with a line: it is a benchmark.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bench {

/// Arguments of the program, each KEY=VALUE.
struct Setup {
  std::string role;       ///< ping, pong, publish or subscribe
  std::string mode;       ///< which of the peer's ways, such as "tcp"
  std::string link;       ///< letters, digits and _; nobody else has it
  std::string folder;     ///< for sockets and pipes that need a path
  std::string sink;       ///< our transports: the URI of the end where messages go in …
  std::string source;     ///< … and of the other; {link}, {folder}, {port} and {readers} are
                          ///< replaced
  int port = 0;           ///< the first of 8 free ports
  int readers = 1;        ///< of each message
  int reader = 0;         ///< which of them this is, from 0
  int rounds = 20'000;    ///< of ping and pong at most
  double seconds = 0.25;  ///< how long to measure at most
  std::size_t bytes = 96;

  [[nodiscard]] bool is_latency() const { return role == "ping" || role == "pong"; }
  /// Small messages are counted in large numbers, so queues are long and clocks read rarely.
  [[nodiscard]] bool is_small() const { return bytes <= 4096; }
};

/// The end where messages go in. Made before any Subscriber of its link is waited for.
class Publisher {
 public:
  Publisher() = default;
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;
  virtual ~Publisher() = default;
  /// Returns when all Setup::readers are there, as far as the peer can tell.
  virtual void await_readers() {}
  /// Room for the next message, whose bytes are all written before publish().
  virtual std::span<std::byte> loan() = 0;
  /// Sends what loan() gave; waits while queues are full, so that nothing is lost.
  virtual void publish() = 0;
  /// Sends a message of Setup::bytes whose bytes were not rewritten.
  virtual void resend() {
    loan();
    publish();
  }
};

/// The end where messages come out.
class Subscriber {
 public:
  Subscriber() = default;
  Subscriber(const Subscriber&) = delete;
  Subscriber& operator=(const Subscriber&) = delete;
  virtual ~Subscriber() = default;
  /// Returns when the publisher is there, as far as the peer can tell.
  virtual void await_writer() {}
  /// Waits for the next message; it is valid until the next call.
  virtual std::span<const std::byte> receive() = 0;
};

/// Ends the program with a line on standard error.
[[noreturn]] void fail(std::string_view what);
/// Ends the program when a system call gave a negative number; else hands the number on.
int require(int result, std::string_view what);

/// The times of round trips, each between two calls of next(); the first are to warm up.
class Rounds {
 public:
  /// Of Setup: at most so many rounds and seconds.
  explicit Rounds(const Setup& setup);
  /// A round has ended, and another begins; false: that was the last.
  bool next();
  /// How many there were, and half of their time: median, and 99 of 100 [µs].
  [[nodiscard]] std::string json();

 private:
  std::size_t limit_, look_every_;
  double seconds_, warm_end_, begin_ = 0, nanoseconds_a_tick_ = 1;
  std::uint64_t begin_ticks_ = 0, last_ = 0;
  std::size_t warm_left_;
  std::vector<std::uint64_t> rounds_;  // [tick]
};

/// Waits a moment inside a loop that polls: first without leaving the processor, later with
/// sched_yield, which others need where there are more processes than processors.
class Spin {
 public:
  void operator()();

 private:
  int tries_ = 0;
};

using MakePublisher = std::unique_ptr<Publisher> (*)(const Setup&);
using MakeSubscriber = std::unique_ptr<Subscriber> (*)(const Setup&);

/// The main() of each program: does what `role` says. It prints `ready`, awaits a line, measures,
/// prints a line of JSON, and stays until its standard input ends, so nobody leaves too early.
int run(int argc, char** argv, MakePublisher make_publisher, MakeSubscriber make_subscriber);

template <typename SomePublisher, typename SomeSubscriber>
int run(int argc, char** argv) {
  return run(
      argc, argv,
      [](const Setup& setup) -> std::unique_ptr<Publisher> {
        return std::make_unique<SomePublisher>(setup);
      },
      [](const Setup& setup) -> std::unique_ptr<Subscriber> {
        return std::make_unique<SomeSubscriber>(setup);
      });
}

}  // namespace bench
