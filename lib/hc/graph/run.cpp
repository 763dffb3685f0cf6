// SPDX-License-Identifier: Apache-2.0
#include <hc/graph/run.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <optional>

#include <hc/graph/process.h>

namespace hc {
namespace {

using internal::Process;
using std::chrono::milliseconds;
using MonotonicClock = std::chrono::steady_clock;

constexpr std::chrono::seconds kGraceToEnd{5};  // between SIGTERM and SIGKILL
constexpr std::chrono::seconds kDescribeTime{10};
constexpr std::size_t kMaxDescription = std::size_t{1} << 20;
constexpr std::size_t kMaxLine = 4096;
constexpr std::size_t kPiece = std::size_t{64} << 10;  // a pipe holds as much
constexpr int kLastPieces = 16;    // a pipe can be made to hold a MiB; source: man 7 pipe
constexpr int kSignal = 128;       // the status of who was killed by one is above
constexpr int kMaxReports = 1024;  // of counters, in one turn

/// A module that runs, or has.
struct Running {
  const PlannedModule* module;
  std::unique_ptr<Source> manage;
  std::unique_ptr<Sink> control;
  std::optional<Process> process;
  std::optional<int> status;
  bool says_more = true;          // its standard error is open
  std::string line;               // what it has begun to say
  std::vector<Traffic> counters;  // of its links, as it reported them last
};

/// How a process has ended, by its status.
std::string end_in_words(int status) {
  if (status == 0) return "ended";
  if (status > kSignal) return "killed by signal " + std::to_string(status - kSignal);
  return "failed with status " + std::to_string(status);
}

class Runner {
 public:
  Runner(const Plan& plan, const RunOptions& options) : plan_(plan), options_(options) {}

  Result<RunReport> run() {
    for (const auto& module : plan_.modules) {
      auto started = start(module);
      if (!started) return started.error();
    }
    Status outcome;
    RunReport report;
    std::optional<MonotonicClock::time_point> kill_at;
    auto end_all = [&] {
      if (kill_at) return;
      kill_at = MonotonicClock::now() + kGraceToEnd;
      for (auto& module : running_)
        if (!module.status) module.process->ask_to_end();
    };
    while (!all_ended()) {
      auto timeout = kill_at ? std::chrono::ceil<milliseconds>(*kill_at - MonotonicClock::now())
                             : milliseconds(-1);
      if (kill_at && timeout <= milliseconds(0)) {
        for (auto& module : running_)
          if (!module.status) module.process->kill();
        timeout = milliseconds(100);
      }
      auto waited = wait_readable(descriptors(), report.stopped ? -1 : options_.stop, timeout);
      if (!waited && waited.error().code == Code::Stopped) {
        report.stopped = true;
        say("graph: stopping");
        end_all();
      }
      const bool is_ending = kill_at.has_value();
      for (auto& module : running_) {
        read_lines(module);
        read_counters(module);
        bool failed = note_end(module);
        // Who was killed is the cause of what others say of their links.
        if (failed && !is_ending && (outcome || *module.status > kSignal)) {
          outcome = Error{Code::Closed,
                          "module " + module.module->name + ": " + end_in_words(*module.status)};
        }
      }
      if (!outcome) end_all();  // behind the others: none is blamed for our own signal
    }
    if (!outcome) return outcome.error();
    for (const auto& link : plan_.links) {
      auto sent = counters_at(link.from, false, link.sender_uri);
      auto left_out = counters_at(link.to, true, link.reader_uri);
      left_out.messages = left_out.bytes = left_out.kept_back = 0;
      report.links.push_back(sent += left_out);
    }
    return report;
  }

 private:
  void say(const std::string& line) const {
    if (options_.event) options_.event(line);
  }

  Status start(const PlannedModule& module) {
    Running running;
    running.module = &module;
    auto uri = parse_uri(module.manage_uri);
    if (!uri) return uri.error();
    auto manage = open_source(*uri);
    if (!manage) return manage.error();
    running.manage = std::move(*manage);
    if (!module.control_uri.empty()) {
      auto place = parse_uri(module.control_uri);
      if (!place) return place.error();
      auto control = open_sink(*place);
      if (!control) return control.error();
      running.control = std::move(*control);
    }
    auto process = Process::start(module.command(), Process::Capture::Errors);
    if (!process) return Error{process.error().code, module.name + ": " + process.error().detail};
    running.process.emplace(std::move(*process));
    running_.push_back(std::move(running));
    say(module.name + ": started");
    return {};
  }

  [[nodiscard]] bool all_ended() const {
    return std::all_of(running_.begin(), running_.end(),
                       [](const Running& module) { return module.status.has_value(); });
  }

  /// Of one end of a link. A module counts its inputs first, both in the order of its command.
  [[nodiscard]] Traffic counters_at(const std::string& place, bool is_input,
                                    const std::string& uri) const {
    auto dot = place.find('.');
    auto running = std::find_if(running_.begin(), running_.end(), [&](const Running& each) {
      return each.module->name == place.substr(0, dot);
    });
    if (running == running_.end()) return {};
    const auto& ends = running->module->ends;
    std::size_t row = 0;
    if (!is_input)
      row = static_cast<std::size_t>(std::count_if(
          ends.begin(), ends.end(), [](const PlannedEnd& end) { return end.is_input; }));
    for (const auto& end : ends) {
      if (end.is_input != is_input) continue;
      if (end.uri == uri && end.port == place.substr(dot + 1)) break;
      ++row;
    }
    return row < running->counters.size() ? running->counters[row] : Traffic{};
  }

  [[nodiscard]] std::vector<int> descriptors() const {
    std::vector<int> all;
    for (const auto& module : running_) {
      if (module.status) continue;
      if (module.says_more) all.push_back(module.process->output());
      all.push_back(module.process->ended());
      all.push_back(module.manage->descriptor());
    }
    return all;
  }

  /// Hands on what a module has said, line by line with its name before it; whether it said
  /// something. Reads one piece only: one who does not stop must not keep us from all else.
  bool read_lines(Running& module) {
    if (!module.says_more) return false;
    ssize_t size = ::read(module.process->output(), piece_.data(), piece_.size());
    if (size < 0) return false;
    for (char c : std::string_view(piece_.data(), static_cast<std::size_t>(size))) {
      if (c != '\n') module.line += c;
      if (c == '\n' || module.line.size() >= kMaxLine) finish_line(module);
    }
    if (size == 0) end_lines(module);
    return size > 0;
  }

  void end_lines(Running& module) const {
    finish_line(module);
    module.says_more = false;
  }

  void finish_line(Running& module) const {
    if (module.line.empty()) return;
    std::string prefix = module.module->name + ": ";
    say(module.line.starts_with(prefix) ? module.line : prefix + module.line);
    module.line.clear();
  }

  static void read_counters(Running& module) {
    Message message;
    for (int report = 0; report < kMaxReports; ++report) {
      auto got = module.manage->take(message);
      if (!got || *got != Got::Message) return;
      auto rows = message.view<std::int64_t>();
      if (!rows || rows->components() < 2 || rows->width() != 1) continue;
      module.counters.clear();
      for (std::size_t row = 0; row < rows->height(); ++row) {
        Counters counters{};
        auto numbers = rows->row(row);
        std::copy_n(numbers.begin(), std::min(numbers.size(), counters.size()), counters.begin());
        module.counters.push_back(traffic_of(counters));
      }
    }
  }

  /// Whether a module has just ended, and not well.
  bool note_end(Running& module) {
    if (module.status) return false;
    module.status = module.process->poll_status();
    if (!module.status) return false;
    read_counters(module);
    // Its last words stand in the pipe; who else still holds that open may do so for ever.
    for (int piece = 0; piece < kLastPieces && read_lines(module);) ++piece;
    end_lines(module);
    say(module.module->name + ": " + end_in_words(*module.status));
    return *module.status != 0;
  }

  const Plan& plan_;
  const RunOptions& options_;
  std::vector<Running> running_;
  std::vector<char> piece_ = std::vector<char>(kPiece);  // of what a module says
};

}  // namespace

Result<RunReport> run_graph(const Plan& plan, const RunOptions& options) {
  return Runner(plan, options).run();
}

Result<std::string> describe_program(const std::string& program) {
  auto process = Process::start({program, "--describe"}, Process::Capture::Output);
  if (!process) return process.error();
  std::string text;
  auto give_up = MonotonicClock::now() + kDescribeTime;
  auto wait = [&](int descriptor) -> Status {
    auto left = std::chrono::ceil<milliseconds>(give_up - MonotonicClock::now());
    std::array<int, 1> descriptors = {descriptor};
    auto ready = wait_readable(descriptors, -1, std::max(left, milliseconds(0)));
    if (!ready) return ready.error();
    if (*ready == 1) return Error{Code::System, program + " --describe does not end"};
    return {};
  };
  while (text.size() <= kMaxDescription) {
    if (auto ready = wait(process->output()); !ready) return ready.error();
    char piece[4096];
    ssize_t size = ::read(process->output(), piece, sizeof piece);
    if (size > 0) text.append(piece, static_cast<std::size_t>(size));
    if (size != 0) continue;
    if (auto ended = wait(process->ended()); !ended) return ended.error();
    int status = process->poll_status().value_or(0);
    if (status == 0) return text;
    return Error{Code::System,
                 program + " --describe failed with status " + std::to_string(status)};
  }
  return Error{Code::System, program + " --describe prints more than a MiB"};
}

std::string graph_token() {
  // Two graphs of one process may run side by side, and process numbers come back.
  return "hc-" + std::to_string(::getpid()) + "-" +
         std::to_string(MonotonicClock::now().time_since_epoch().count());
}

}  // namespace hc
