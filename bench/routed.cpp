// SPDX-License-Identifier: Apache-2.0
// What a hop through the router costs over shared memory, beside a direct link: latency of messages
// of 96 bytes, messages a second, and its share of a processor at 1,200 messages a second. The
// latency is from a process through the router back to the same one, of a direct link half a round
// trip, so either takes two processors.
//
//     build/bench/routed [ROUNDS]    default 5
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <hc/link/link.h>

#include "measure.h"

namespace {

namespace fs = std::filesystem;
using bench::fail, bench::median, bench::must;
using Clock = std::chrono::steady_clock;
using Microseconds = std::chrono::duration<double, std::micro>;

constexpr std::int32_t kAddress = 21;
constexpr std::int32_t kElements = 42;  // with a header of 53 bytes and a line feed 96
constexpr std::int64_t kRoundTrips = 20'000, kMany = 2'000'000;

std::unique_ptr<hc::Sink> sink(const std::string& uri) {
  return must(hc::open_sink(must(hc::parse_uri(uri))));
}
std::unique_ptr<hc::Source> source(const std::string& uri) {
  return must(hc::open_source(must(hc::parse_uri(uri))));
}

void take(hc::Source& from, hc::Message& message) {
  if (!must(hc::receive(from, message))) fail("a link has ended too early");
}

/// Names of links that no other run has.
std::string link(const char* what) {
  return "shm:routed_" + std::to_string(::getpid()) + "_" + what;
}

/// A program of its own, since one that is forked has no threads that serve its links.
/// @param out  its standard output; -1: as ours.
pid_t start(std::vector<std::string> words, int out = -1) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (out >= 0) posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
  pid_t pid = 0;
  if (posix_spawn(&pid, words[0].c_str(), &actions, nullptr, arguments.data(), environ) != 0)
    fail(words[0] + " cannot be started");
  posix_spawn_file_actions_destroy(&actions);
  return pid;
}

/// The router, from the link "in" to the link "out", perhaps with another one that is silent, as
/// routers of a graph have.
pid_t start_router(const std::string& path, bool has_another = false) {
  const std::string out = "out=" + link("out") + "?readers=1";
  std::vector<std::string> words = {path, "--in",    "in=" + link("in") + "?wait=10", "--out",
                                    out,  "--route", out + " to=21 peer=receiver"};
  if (has_another) {
    words.emplace_back("--in");
    words.emplace_back("in=" + link("silent") + "?wait=10");
  }
  return start(std::move(words));
}

void await_end(pid_t pid) {
  int status = 0;
  if (::waitpid(pid, &status, 0) < 0 || status != 0) fail("a process has failed");
}

/// What a process has used of a processor so far, its threads together. [s]
double processor_time(pid_t pid) {
  double sum = 0;
  for (const auto& task : fs::directory_iterator("/proc/" + std::to_string(pid) + "/task")) {
    double nanoseconds = 0;
    std::ifstream(task.path() / "schedstat") >> nanoseconds;
    sum += 1e-9 * nanoseconds;
  }
  return sum;
}

hc::Message message() {
  hc::Header header;
  header.src = 11;
  header.dst = kAddress;
  header.time = hc::unix_time(1'700'000'000'000'000'000);
  header.info = {hc::MatrixType::Table, 1, hc::Scalar::U8, hc::Encoding::Binary};
  header.width = kElements;
  header.height = 1;
  hc::Draft draft = hc::Draft::make(header);
  std::memset(draft.elements().data(), 7, draft.elements().size());
  return std::move(draft).finish();
}

// What the other processes do, by the first argument.

void echo(const std::string& there, const std::string& back) {
  auto to = sink(back + "?readers=1");
  auto from = source(there + "?wait=10");
  hc::Message message;
  for (std::int64_t i = 0; i < kRoundTrips; ++i) {
    take(*from, message);
    must(to->send(message));
  }
  must(to->close());
}

/// Prints messages a second, from the first to the last one.
void count(const std::string& uri) {
  auto from = source(uri + "?wait=10");
  hc::Message message;
  take(*from, message);
  auto begin = Clock::now();
  for (std::int64_t i = 1; i < kMany; ++i) {
    take(*from, message);
    if (message.header.seq != i) fail("a message was lost");
  }
  std::chrono::duration<double> passed = Clock::now() - begin;
  std::printf("%.0f\n", static_cast<double>(kMany - 1) / passed.count());
}

void drain(const std::string& uri) {
  auto from = source(uri + "?wait=10");
  hc::Message message;
  while (must(hc::receive(*from, message))) {
  }
}

/// From sending at one link to hearing at another, the echo or the router between them. [µs]
double round_trip(const std::string& sent_to, const std::string& heard) {
  std::vector<double> times;
  auto to = sink(sent_to + "?readers=1");
  auto from = source(heard + "?wait=10");
  hc::Message sent = message(), got;
  for (; sent.header.seq < kRoundTrips; ++sent.header.seq) {
    auto begin = Clock::now();
    must(to->send(sent));
    take(*from, got);
    times.push_back(Microseconds(Clock::now() - begin).count());
  }
  must(to->close());
  return median(times);
}

/// Messages a second that go in at one link and come out at another or the same.
double messages_a_second(const std::string& self, const std::string& sent_to,
                         const std::string& heard) {
  int ends[2];
  if (::pipe(ends) != 0) fail("no pipe");
  pid_t other = start({self, "count", heard}, ends[1]);
  auto to = sink(sent_to + "?readers=1");
  for (hc::Message sent = message(); sent.header.seq < kMany; ++sent.header.seq)
    must(to->send(sent));
  must(to->close());
  await_end(other);
  char line[64] = {};
  if (::read(ends[0], line, sizeof line - 1) <= 0) fail("no receiver");
  ::close(ends[0]);
  ::close(ends[1]);
  return std::atof(line);
}

/// The router's share of a processor at 1,200 messages a second, without its start. [1]
double processor_share(const std::string& self, const std::string& router) {
  constexpr std::int64_t kRate = 1200, kWarm = kRate, kLast = 6 * kRate;
  pid_t pid = start_router(router, true);
  pid_t receiver = start({self, "drain", link("out")});
  auto silent = sink(link("silent") + "?readers=1");
  auto to = sink(link("in") + "?readers=1");
  hc::Message sent = message();
  double used = 0;
  auto begin = Clock::now(), measured = begin;
  for (; sent.header.seq < kLast; ++sent.header.seq) {
    std::this_thread::sleep_until(begin + sent.header.seq *
                                              Clock::duration(std::chrono::seconds(1)) / kRate);
    if (sent.header.seq == kWarm) {
      used = processor_time(pid);
      measured = Clock::now();
    }
    must(to->send(sent));
  }
  used = processor_time(pid) - used;
  std::chrono::duration<double> passed = Clock::now() - measured;
  must(to->close());
  must(silent->close());
  await_end(pid);
  await_end(receiver);
  return used / passed.count();
}

}  // namespace

int main(int argc, char** argv) {
  const std::string role = argc > 1 ? argv[1] : "";
  if (role == "echo") return echo(argv[2], argv[3]), 0;
  if (role == "count") return count(argv[2]), 0;
  if (role == "drain") return drain(argv[2]), 0;
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 5;
  const std::string self = fs::canonical("/proc/self/exe");
  const std::string router =
      fs::path(self).parent_path().parent_path() / "libexec/hypercolumn/router";
  std::vector<double> direct, hop, part, direct_rate, rate;
  for (int round = 0; round < rounds; ++round) {
    pid_t pid = start({self, "echo", link("direct"), link("back")});
    direct.push_back(round_trip(link("direct"), link("back")) / 2);
    await_end(pid);
    pid = start_router(router);
    hop.push_back(round_trip(link("in"), link("out")));
    await_end(pid);
    part.push_back(hop.back() / (2.6 * direct.back() + 1));
    direct_rate.push_back(messages_a_second(self, link("direct"), link("direct")));
    pid = start_router(router);
    rate.push_back(messages_a_second(self, link("in"), link("out")));
    await_end(pid);
  }
  std::printf("96 bytes over shm, medians of %d rounds\n", rounds);
  std::printf("direct link                  %8.2f µs\n", median(direct));
  std::printf("through the router           %8.2f µs = %.2f of (1.3 x 2 direct + 1 µs)\n",
              median(hop), median(part));
  std::printf("direct, messages a second    %8.0f\n", median(direct_rate));
  std::printf("routed, messages a second    %8.0f\n", median(rate));
  std::printf("router at 1,200 messages/s   %8.2f %% of a processor\n",
              100 * processor_share(self, router));
}
