// SPDX-License-Identifier: Apache-2.0
// hc replay: runs each module of a recorded graph again with its recorded inputs, on the clock of
// the messages, and compares its outputs with the recording.

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include <graph/process.h>
#include <hc/base/clock.h>
#include <hc/base/format.h>
#include <hc/base/uri.h>
#include <hc/compress/compress.h>
#include <hc/compress/convert.h>
#include <hc/os/program.h>
#include <hc/os/wait_readable.h>

#include "common.h"
#include "comparison.h"
#include "graph.h"
#include "graph_recording.h"
#include "output_settings.h"
#include "replay_inputs.h"
#include "verbs.h"

namespace tool {
namespace {

namespace fs = std::filesystem;
using What = hc::TraceEvent::What;

struct ReplayOptions {
  std::string recording, out;
  hc::LoadOptions graph;
  std::vector<std::string> except, numbers, shares;
  bool check = false;
  double timeout = 300;
};

/// Makes the folder for outputs: the given one, or a temporary one.
fs::path make_folder(const std::string& given) {
  std::error_code failed;
  if (!given.empty()) {
    fs::create_directories(given, failed);
    if (failed) throw Failure(hc::Code::System, given + ": " + failed.message());
    return given;
  }
  std::string name = fs::temp_directory_path(failed) / "hc-replay-XXXXXX";
  if (failed || ::mkdtemp(name.data()) == nullptr)
    throw Failure(hc::Code::System, name + ": cannot make the folder");
  return name;
}

class Replay {
 public:
  explicit Replay(const ReplayOptions& options)
      : options_(options),
        recording_(options.recording),
        plan_(load()),
        numbers_("--tolerance", options.numbers, 0),
        shares_("--share", options.shares, 1) {
    std::set<std::string> known;
    for (const auto& module : plan_.modules) {
      known.insert(module.name);
      for (const auto& output : recorded_outputs(module)) known.insert(module.name + "." + output);
    }
    for (const auto* settings : {&numbers_, &shares_}) settings->check(known);
    for (const auto& name : options.except) check_known(name, known);
  }
  ~Replay() {
    std::error_code failed;
    if (options_.out.empty() && !folder_.empty()) fs::remove_all(folder_, failed);
  }
  Replay(const Replay&) = delete;
  Replay& operator=(const Replay&) = delete;

  void run() {
    folder_ = make_folder(options_.out);
    std::vector<std::string> differing;
    std::size_t compared = 0;
    for (const auto& module : plan_.modules) {
      if (hc::stop_requested()) throw Failure(0);
      const auto trace = RecordedTrace::read(recording_, module.name);
      const auto reason = why_not(module, trace);
      if (!reason.empty()) {
        print(hc::format("{}: not run: {}\n", module.name, reason));
        continue;
      }
      run_module(module, trace);
      if (!options_.check) {
        print_counts(module);
        continue;
      }
      for (const auto& output : recorded_outputs(module)) {
        const std::string name = module.name + "." + output;
        if (is_excepted(name)) continue;
        ++compared;
        if (!compare_output(name)) differing.push_back(name);
      }
    }
    if (!options_.check) return;
    if (compared == 0) throw Failure(hc::Code::NotFound, "nothing to compare");
    if (differing.empty()) return;
    std::string all;
    for (const auto& name : differing) all += " --except " + name;
    say(
        hc::format("hc replay: {} of {} outputs differ from the recording; leave out what depends "
                   "on a device or on real time:{}",
                   differing.size(), compared, all));
    throw Failure(1);
  }

 private:
  [[nodiscard]] hc::Plan load() const {
    auto graph = options_.graph;
    if (graph.file.empty()) graph.file = recording_.graph_file();
    if (graph.file.empty())
      throw Failure(hc::Code::Invalid,
                    "give --graph FILE: " + options_.recording + " does not name its graph file");
    graph.programs_here = true;
    return load_plan("replay", graph, nullptr);
  }

  /// The recorded outputs of a module, except for its trace.
  [[nodiscard]] std::vector<std::string> recorded_outputs(const hc::PlannedModule& module) const {
    std::vector<std::string> ports;
    for (const auto& output : recording_.outputs())
      if (const auto dot = output.find('.');
          output.substr(0, dot) == module.name && output.substr(dot + 1) != hc::kTracePort)
        ports.push_back(output.substr(dot + 1));
    return ports;
  }

  /// Whether a module sent a message that was recorded: one may be killed before it has begun.
  [[nodiscard]] bool has_sent(const hc::PlannedModule& module) const {
    return std::ranges::any_of(recorded_outputs(module), [&](const std::string& port) {
      const auto output = module.name + "." + port;
      const auto source = recording_.open(output);
      hc::Message message;
      return recording_.receive(*source, message, output);
    });
  }

  [[nodiscard]] bool is_excepted(const std::string& name) const {
    return std::ranges::find(options_.except, name) != options_.except.end();
  }

  /// The link by which an input gets its messages; its sender is "MODULE.PORT", or a URI.
  [[nodiscard]] Feed feed_of(const hc::PlannedModule& module, const hc::PlannedEnd& end) const {
    Feed feed{end.uri, end.port};
    for (const auto& other : module.ends) {
      if (&other == &end) break;
      if (other.is_input && other.port == end.port) ++feed.number;
    }
    for (const auto& link : plan_.links) {
      if (link.to != module.name + "." + end.port || link.reader_uri != end.uri) continue;
      feed.output = link.from;
      if (auto uri = hc::parse_uri(link.sender_uri)) feed.add(0, std::move(*uri));
      feed.add_changes(changes_of(link.from.substr(0, link.from.find('.'))), link.to);
      break;
    }
    return feed;
  }

  /// Whether a module's clock is that of its messages; a trace has the machine's moments, which say
  /// nothing of it.
  static bool is_in_time_of_messages(const hc::PlannedModule& module) {
    const std::array by_messages = {std::string("--clock"), std::string("messages")};
    const auto& words = module.options;
    return std::search(words.begin(), words.end(), by_messages.begin(), by_messages.end()) !=
           words.end();
  }

  /// Why a module cannot be replayed; empty: it can.
  [[nodiscard]] std::string why_not(const hc::PlannedModule& module,
                                    const RecordedTrace& trace) const {
    if (is_excepted(module.name)) return "excepted";
    std::map<std::string, std::int32_t> links;  // of each input
    for (const auto& end : module.ends) {
      if (!end.is_input) continue;
      ++links[end.port];
      const auto feed = feed_of(module, end);
      const auto& writer = feed.output;
      if (writer.find(':') != std::string::npos) return writer + " is outside the graph";
      if (!recording_.has(writer)) return writer + " is not in the recording";
      if (!feed.hindrance.empty()) return feed.hindrance;
    }
    if (links.empty()) return "a sensor: its outputs come from the recording";
    if (recorded_outputs(module).empty()) return "none of its outputs was recorded";
    if (trace.events.empty() && !has_sent(module)) return "it sent nothing while it was recorded";
    if (module.control_uri.empty()) return "its program has no --clock";
    if (trace.was_restarted) return "it was restarted while it was recorded";
    for (const auto& event : trace.events) {
      if (event.what == What::Set && is_in_time_of_messages(module))
        return "its parameter " + event.port +
               " was set while it was recorded, and its clock is that of the messages";
      if (event.what == What::Took && event.port != kFocus && event.number >= links[event.port])
        return "it was linked to something else while it was recorded, at " + event.port;
    }
    return "";
  }

  /// The trace of a module if commands changed its links; else one without events, which takes no
  /// memory.
  const RecordedTrace& changes_of(const std::string& module) const {
    const auto [found, is_new] = changes_.try_emplace(module);
    if (!is_new) return found->second;
    auto trace = RecordedTrace::read(recording_, module);
    if (std::ranges::any_of(trace.events, [](const auto& event) {
          return event.what == What::Linked || event.what == What::Unlinked;
        }))
      found->second = std::move(trace);
    return found->second;
  }

  std::vector<std::string> command_of(const hc::PlannedModule& module, const RecordedTrace& trace) {
    std::vector<std::string> words = {module.program};
    words.insert(words.end(), module.options.begin(), module.options.end());
    for (const auto& [key, value] : module.parameters) words.push_back("--" + key + "=" + value);
    auto steps = trace.steps();
    const bool is_in_their_time = is_in_time_of_messages(module);
    const bool is_known = !steps.empty() && !is_in_their_time;
    const auto add = [&](const char* option, const hc::PlannedEnd& end, const fs::path& file) {
      const std::string link = end.port + "=file:" + file.string();
      words.insert(words.end(), {option, link});
      if (!end.route.empty()) words.insert(words.end(), {"--route", link + " " + end.route});
    };
    taken_.clear();
    auto whole = trace.whole();
    std::string cut;  // where the replay ends before the recording
    for (const auto& end : module.ends) {
      if (!end.is_input) continue;
      const auto feed = feed_of(module, end);
      const auto file = folder_ / hc::format("{}.{}.{}.in", module.name, end.port, feed.number);
      if (!is_known) {
        feed.write_all(recording_, file);
        taken_[end.port] += count(file);
      } else if (const auto missing = feed.write_handled(recording_, steps, file)) {
        whole = trace.before(*missing);
        cut = hc::format(
            "{}: replayed up to {:.3f} s: a message that it took then at {} is not in "
            "the recording of {}\n",
            module.name, hc::seconds(missing->moment - trace.events[0].moment), feed.port,
            feed.output);
      }
      add("--in", end, file);
    }
    print(cut);
    for (const auto& step : steps)
      if (step.what == What::Began && !step.port.empty() && step.port != kFocus)
        ++taken_[step.port];
    if (is_known)
      for (const auto& port : recorded_outputs(module)) last_[module.name + "." + port] = -1;
    for (const auto& event : whole)
      if (event.what == What::Sent) last_[module.name + "." + event.port] = event.seq;
    for (const auto& port : recorded_outputs(module)) {
      const auto end = std::ranges::find_if(
          module.ends, [&](const auto& each) { return !each.is_input && each.port == port; });
      add("--out", end != module.ends.end() ? *end : hc::PlannedEnd{false, port, "", ""},
          folder_ / (module.name + "." + port + ".mtp"));
    }
    const fs::path clock = folder_ / (module.name + ".clock");
    if (is_known) write_steps(steps, clock);
    if (!is_in_their_time)
      words.insert(words.end(), {"--clock", is_known ? "file:" + clock.string() : "messages"});
    return words;
  }

  /// The messages in a file.
  static std::uint64_t count(const fs::path& file) {
    const auto source = open_file_source(file, kDefaultLimit);
    std::uint64_t messages = 0;
    for (hc::Message message; receive(*source, message, file);) ++messages;
    return messages;
  }

  /// Prints how many messages a module that was run has got and sent.
  void print_counts(const hc::PlannedModule& module) const {
    for (const auto& [port, messages] : taken_)
      print(hc::format("{}.{}: {} taken\n", module.name, port, counted(messages, "message")));
    for (const auto& port : recorded_outputs(module)) {
      const auto name = module.name + "." + port;
      const auto file = folder_ / (name + ".mtp");
      print(hc::format("{}: {} sent\n", name, counted(count(file), "message")));
    }
  }

  void run_module(const hc::PlannedModule& module, const RecordedTrace& trace) {
    using hc::Process;
    const auto command = command_of(module, trace);
    auto process = value_or_fail(Process::start(command, Process::Capture::Errors), module.name);
    const auto end = std::chrono::steady_clock::now() + hc::duration(options_.timeout);
    std::string errors;
    std::array<char, 4096> piece{};
    std::optional<int> status;
    for (bool is_open = true; is_open || !(status = process.poll_status());) {
      const auto left =
          std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
      if (left.count() <= 0)
        throw Failure(hc::Code::Closed,
                      hc::format("{} has not ended after {} s; raise --timeout, or skip it with "
                                 "--except",
                                 module.name, options_.timeout));
      const std::array watched = {is_open ? process.output() : process.ended()};
      const auto ready = hc::wait_readable(watched, hc::stop_descriptor(), left);
      if (!ready) throw Failure(module.name, ready.error());
      if (*ready != 0 || !is_open) continue;
      const auto size = ::read(watched[0], piece.data(), piece.size());
      is_open = size > 0;
      if (is_open) errors.append(piece.data(), static_cast<std::size_t>(size));
      if (errors.size() > kMaxErrors) errors.erase(0, errors.size() - kMaxErrors);
    }
    if (*status == 0) return;
    errors.erase(0, errors.find_last_of('\n', errors.size() < 2 ? 0 : errors.size() - 2) + 1);
    while (errors.ends_with('\n')) errors.pop_back();
    throw Failure(hc::Code::Closed,
                  hc::format("{} failed with status {}: {}", module.name, *status, errors));
  }

  bool compare_output(const std::string& output) {
    const std::string again = folder_ / (output + ".mtp");
    const auto source = recording_.open(output), made = open_file_source(again, kDefaultLimit);
    auto expand = [](hc::Message& message, const std::string& place) {
      message = value_or_fail(hc::expand(message), place);
      return true;
    };
    auto recorded = [&](hc::Message& message) {
      return recording_.receive(*source, message, output) &&
             expand(message, recording_.place_of(output));
    };
    auto replayed = [&](hc::Message& message) {
      return receive(*made, message, again) && expand(message, again);
    };
    const Tolerance tolerance{numbers_.of(output), shares_.of(output)};
    const auto last = last_.find(output);
    const auto result = last == last_.end() ? compare(recorded, replayed, tolerance)
                                            : compare(recorded, replayed, tolerance, last->second);
    const bool is_same = result.is_same(tolerance);
    print(hc::format("{}{}: {}\n", is_same ? "" : "DIFFERS ", output, result.text()));
    return is_same;
  }

  static constexpr std::size_t kMaxErrors = 16 << 10;  // [byte]

  const ReplayOptions& options_;
  const GraphRecording recording_;
  hc::Plan plan_;
  fs::path folder_;  // removed at the end, unless given
  OutputSettings numbers_, shares_;
  std::map<std::string, std::uint64_t> taken_;  // messages of the module that was run last, by port
  mutable std::map<std::string, RecordedTrace> changes_;  // see changes_of()
  std::map<std::string, std::int64_t> last_;  // last `seq` sent in a complete step, by output
};

}  // namespace

void add_replay(CLI::App& app) {
  auto options = std::make_shared<ReplayOptions>();
  options->graph.token = hc::graph_token();
  auto* verb = app.add_subcommand(
      "replay", "Run the modules of a recorded graph again, and compare their outputs");
  auto many = [&](const char* name, std::vector<std::string>& words, const char* doc) {
    verb->add_option(name, words, doc)->allow_extra_args(false);
  };
  verb->add_option("recording", options->recording, "folder or .mcap of hc run --record")
      ->required();
  verb->add_option("--graph", options->graph.file,
                   "the graph file that was run (default: the one named in a .mcap)")
      ->transform(find_graph);
  many("--set", options->graph.settings, "MODULE.PARAMETER=VALUE, as given to hc run");
  verb->add_flag("--check", options->check, "compare; status 1 if something differs");
  verb->add_option("--out", options->out, "keep the modules' outputs in this folder");
  many("--except", options->except, "MODULE not to run, or MODULE.PORT not to compare; repeatable");
  many("--tolerance", options->numbers, "[MODULE[.PORT]=]NUMBER by which numbers may differ");
  many("--share", options->shares, "[MODULE[.PORT]=]SHARE of messages that must be equal");
  verb->add_option("--timeout", options->timeout, "for each module [s]")
      ->check(number_in(0.1, 86400));
  verb->callback([options] { Replay(*options).run(); });
}

}  // namespace tool
