// SPDX-License-Identifier: Apache-2.0
// What a reader of a shared memory link that is stopped for a while costs others, and how soon it
// is up to date again: a publisher, a reader of every message, and one of the latest, which is
// stopped for the second half. Each is a process.
//
//     build/bench/stopped_reader [SECONDS [MESSAGES-A-SECOND [BYTES]]]    default 60 1000 100000
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
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
using bench::fail, bench::must;
using Clock = std::chrono::steady_clock;
using std::chrono::nanoseconds;
using std::chrono::seconds;

/// The same in every process, since they are forked.
struct Plan {
  std::string name;
  seconds half{60};
  std::int64_t rate = 1000;  // [message/s]
  std::int32_t bytes = 100'000;
  Clock::time_point begin;  // of the first half

  [[nodiscard]] Clock::time_point stop() const { return begin + half; }
  [[nodiscard]] Clock::time_point resume() const { return begin + 2 * half; }
  [[nodiscard]] Clock::time_point end() const { return resume() + seconds(1); }
};

/// What a process has to say at its end.
struct Report {
  std::uint64_t sent = 0, received = 0, dropped_newer = 0, lost = 0;
  std::array<std::array<double, 4>, 2> latencies{};  // of each half, see summary() [µs]
  std::int64_t woken = 0;                            // of the first message after the longest gap
  double age_us = 0;                                 // of that message then
};

std::int64_t number(Clock::time_point time) {
  return time.time_since_epoch().count();
}

Report publish(const Plan& plan) {
  auto sink = must(hc::open_sink(*hc::parse_uri(plan.name + "?readers=2")));
  hc::Header header;
  header.info = {hc::MatrixType::IntensityImage, 1, hc::Scalar::U8, hc::Encoding::Binary};
  header.width = plan.bytes;
  header.height = 1;
  const nanoseconds period(std::nano::den / plan.rate);
  for (auto next = Clock::now(); next < plan.end(); next += period, ++header.seq) {
    std::this_thread::sleep_until(next);
    auto draft = sink->loan(header);
    std::memset(draft.elements().data(), static_cast<int>(header.seq), draft.elements().size());
    draft.header.time = hc::unix_time(number(Clock::now()));
    must(sink->send(std::move(draft).finish()));
  }
  must(sink->close());
  Report report;
  report.sent = sink->traffic().messages;
  report.lost = sink->traffic().dropped_memory;
  return report;
}

double part_of(std::vector<double>& values, double part) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

/// Medians over the seconds, which what else the host does disturbs least; and all together.
std::array<double, 4> summary(std::vector<std::vector<double>> seconds_of_values) {
  std::vector<double> medians, tails, all;
  for (auto& values : seconds_of_values) {
    medians.push_back(part_of(values, 0.5));
    tails.push_back(part_of(values, 0.99));
    all.insert(all.end(), values.begin(), values.end());
  }
  return {part_of(medians, 0.5), part_of(tails, 0.5), part_of(all, 0.99), part_of(all, 1)};
}

Report read(const Plan& plan, const std::string& keep) {
  auto source = must(hc::open_source(*hc::parse_uri(plan.name + "?wait=10&keep=" + keep)));
  const auto count = static_cast<std::size_t>(plan.half.count());
  std::vector<std::vector<double>> latencies(2 * count);  // of each second
  Report report;
  hc::Message message;
  auto last = Clock::now();
  Clock::duration longest{};
  while (true) {
    if (!must(hc::receive(*source, message))) break;
    auto now = Clock::now();
    auto age = static_cast<double>(number(now) - hc::unix_nanoseconds(message.header.time)) / 1000;
    if (now - last > longest) {
      longest = now - last;
      report.woken = number(now);
      report.age_us = age;
    }
    last = now;
    if (now >= plan.begin && now < plan.resume())
      latencies.at(static_cast<std::size_t>((now - plan.begin) / seconds(1))).push_back(age);
  }
  auto middle = latencies.begin() + static_cast<std::ptrdiff_t>(count);
  report.latencies = {summary({latencies.begin(), middle}), summary({middle, latencies.end()})};
  report.received = source->traffic().messages;
  report.dropped_newer = source->traffic().dropped_newer;
  return report;
}

struct Process {
  pid_t pid = -1;
  int pipe = -1;

  template <typename Role>
  explicit Process(const Role& role) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) fail("pipe");
    pid = ::fork();
    if (pid == 0) {
      Report report = role();
      if (::write(ends[1], &report, sizeof report) != sizeof report) fail("write");
      std::_Exit(0);
    }
    ::close(ends[1]);
    pipe = ends[0];
  }
  [[nodiscard]] Report end() const {
    Report report;
    if (::read(pipe, &report, sizeof report) != sizeof report) fail("a process has failed");
    ::waitpid(pid, nullptr, 0);
    return report;
  }
};

/// What is behind the memory that a publisher shares. [MiB]
double shared_by(pid_t pid) {
  std::error_code gone;
  for (const auto& entry : fs::directory_iterator("/proc/" + std::to_string(pid) + "/fd", gone)) {
    struct stat status {};
    if (fs::read_symlink(entry, gone).string().find("memfd:hypercolumn") != std::string::npos &&
        ::stat(entry.path().c_str(), &status) == 0 && status.st_size > (1 << 20))
      return static_cast<double>(status.st_blocks) * 512 / (1 << 20);
  }
  return 0;
}

double resident(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/statm");
  std::int64_t pages = 0;
  file >> pages >> pages;
  return static_cast<double>(pages * ::sysconf(_SC_PAGESIZE)) / (1 << 20);
}

}  // namespace

int main(int argc, char** argv) {
  Plan plan;
  if (argc > 1) plan.half = seconds(std::atoi(argv[1]));
  if (argc > 2) plan.rate = std::atoll(argv[2]);
  if (argc > 3) plan.bytes = std::atoi(argv[3]);
  plan.name = "shm:bench-" + std::to_string(::getpid());
  plan.begin = Clock::now() + seconds(2);
  Process publisher([&] { return publish(plan); });
  Process steady([&] { return read(plan, "all"); });
  Process stopped([&] { return read(plan, "latest"); });
  std::this_thread::sleep_until(plan.stop());
  ::kill(stopped.pid, SIGSTOP);
  double shared = 0, resident_before = resident(publisher.pid), resident_most = 0;
  for (auto next = plan.stop(); next < plan.resume(); next += seconds(1)) {
    std::this_thread::sleep_until(next);
    shared = std::max(shared, shared_by(publisher.pid));
    resident_most = std::max(resident_most, resident(publisher.pid));
  }
  std::this_thread::sleep_until(plan.resume());
  auto resumed = number(Clock::now());
  ::kill(stopped.pid, SIGCONT);
  auto sent = publisher.end(), all = steady.end(), some = stopped.end();
  std::printf("%llu messages of %d bytes, %lld a second; a reader stopped for %lld s\n",
              static_cast<unsigned long long>(sent.sent), plan.bytes,
              static_cast<long long>(plan.rate), static_cast<long long>(plan.half.count()));
  std::printf("latency of the other reader [us]   p50, p99 of a second  p99 of all  most\n");
  for (std::size_t half = 0; half < 2; ++half) {
    const auto& values = all.latencies.at(half);
    std::printf("  %-30s %8.1f%15.1f%12.1f%6.0f\n",
                half == 0 ? "before" : "while the one is stopped", values[0], values[1], values[2],
                values[3]);
  }
  std::printf(
      "publisher's memory: %.1f MiB shared at most, %.1f MiB resident before, %.1f at most\n",
      shared, resident_before, resident_most);
  std::printf("first message %.2f ms after waking, %.2f ms old\n",
              static_cast<double>(some.woken - resumed) / 1e6, some.age_us / 1000);
  auto counted = some.received + some.dropped_newer;
  std::printf("the other has %llu; the one has %llu and lost %llu: %s\n",
              static_cast<unsigned long long>(all.received),
              static_cast<unsigned long long>(some.received),
              static_cast<unsigned long long>(some.dropped_newer),
              counted == sent.sent && all.received == sent.sent && sent.lost == 0
                  ? "every message is counted"
                  : "SOME MESSAGES ARE NOT COUNTED");
  return 0;
}
