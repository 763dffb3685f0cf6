// SPDX-License-Identifier: Apache-2.0
// hc trace: shows what messages were derived from, and how long each step took.

#include <algorithm>
#include <chrono>
#include <set>

#include <hc/base/clock.h>
#include <hc/base/format.h>
#include <hc/base/suggestion.h>
#include <hc/link/wait_set.h>
#include <hc/os/new_file.h>
#include <hc/os/program.h>

#include <nlohmann/json.hpp>

#include "chrome_trace.h"
#include "common.h"
#include "graph.h"
#include "graph_recording.h"
#include "observer.h"
#include "trace_paths.h"
#include "verbs.h"
#include "words.h"

namespace tool {
namespace {

using MonotonicClock = std::chrono::steady_clock;

constexpr std::size_t kMostEvents = 5'000'000;
constexpr std::size_t kMostPathsShown = 6;
constexpr std::string_view kSuffix = ".trace";  // of an output

struct TraceOptions {
  std::string port, of, recording, perfetto;
  hc::LoadOptions graph;
  double duration = 5;
  bool json = false;
};

struct Collected {
  Traced traced;
  std::size_t events = 0;
  std::int64_t lost = 0;

  void add(const std::string& module, const hc::Message& message) {
    auto& known = traced.events[module];
    for (auto& event : hc::read_trace(message)) {
      if (event.what == hc::TraceEvent::What::Lost)
        lost += event.seq;
      else if (events == kMostEvents)
        ++lost;
      else
        known.push_back(std::move(event)), ++events;
    }
  }
};

using Links = std::vector<std::pair<std::string, std::string>>;

/// A module and all modules whose messages lead to it.
std::set<std::string> upstream_of(const std::string& module, const Links& links) {
  std::set<std::string> found = {module};
  for (std::size_t before = 0; before != found.size();) {
    before = found.size();
    for (const auto& [from, to] : links)
      if (found.contains(module_of(to))) found.insert(module_of(from));
  }
  return found;
}

/// Fails if no link has this port.
void check_port(const std::string& port, const Links& links) {
  std::vector<std::string> known;
  for (const auto& [from, to] : links)
    for (const auto& each : {from, to})
      if (each.find(':') == std::string::npos) known.push_back(each);
  if (std::ranges::find(known, port) != known.end()) return;
  std::vector<std::string> linked;
  for (const auto& each : std::set(known.begin(), known.end()))
    if (module_of(each) == module_of(port)) linked.push_back(each);
  const std::string hint = linked.empty()
                               ? ""
                               : "; only messages over a link are traced: link it (hc graph link) "
                                 "or trace one of " +
                                     joined(linked);
  throw Failure(hc::Code::Invalid,
                "no linked port \"" + port + "\"" + hc::suggestion(port, known) + hint);
}

Collected collect(const TraceOptions& options) {
  using namespace std::chrono_literals;
  constexpr auto kLast = 1s;  // modules report twice a second
  const auto graph = choose_running(options.of);
  const auto state = state_of(graph);
  Collected collected;
  auto& links = collected.traced.links;
  for (const auto& link : state.links) links.emplace_back(link.from, link.to);
  if (!options.port.empty()) check_port(options.port, links);
  const auto wanted = upstream_of(module_of(options.port), links);
  struct Watched {
    std::string module;
    std::unique_ptr<hc::Source> source;
  };
  std::vector<Watched> watched;
  for (const auto& module : state.modules) {
    if (options.perfetto.empty() && !wanted.contains(module.name)) continue;
    if (module.status != hc::ModuleStatus::Running) continue;
    auto source =
        hc::open_tap(graph, module.name + "." + hc::kTracePort, link_options(kDefaultLimit));
    if (!source && source.error().code == hc::Code::Invalid) continue;  // takes no commands
    if (!source) throw Failure(source.error());
    collected.traced.events[module.name];
    watched.push_back({module.name, std::move(*source)});
  }
  hc::WaitSet waits(hc::stop_descriptor());
  hc::Message message;
  const auto begin = MonotonicClock::now();
  const auto end = begin + hc::duration(options.duration) + kLast;
  Progress progress("hc trace");
  while (MonotonicClock::now() < end && !hc::stop_requested()) {
    std::erase_if(watched, [&](const Watched& each) {
      auto got = each.source->take(message);
      for (; got && *got == hc::Got::Message; got = each.source->take(message))
        collected.add(each.module, message);
      return !got || *got == hc::Got::End;
    });
    if (watched.empty()) break;
    std::vector<hc::Source*> open;
    for (const auto& each : watched) open.push_back(each.source.get());
    progress.show((MonotonicClock::now() - begin) / std::chrono::duration<double>(end - begin),
                  hc::format("{} events", collected.events));
    static_cast<void>(waits.wait(open, {}, 100ms));
  }
  return collected;
}

Collected read_recording(const TraceOptions& options) {
  Collected collected;
  const GraphRecording recording(options.recording);
  for (const auto& output : recording.outputs()) {
    if (!output.ends_with(kSuffix)) continue;
    const auto module = module_of(output);
    collected.traced.events[module];
    const auto source = recording.open(output);
    hc::Message message;
    while (recording.receive(*source, message, output)) collected.add(module, message);
  }
  if (collected.traced.events.empty())
    throw Failure(hc::Code::NotFound, options.recording + " has no MODULE" + std::string(kSuffix) +
                                          "; hc run --record writes them");
  if (!options.graph.file.empty())
    for (const auto& link : look_at_plan("trace", options.graph).links)
      collected.traced.links.emplace_back(link.from, link.to);
  if (!options.port.empty() && !options.graph.file.empty())
    check_port(options.port, collected.traced.links);
  return collected;
}

std::string milliseconds(nanoseconds duration) {
  const double value = static_cast<double>(duration.count()) * 1e-6;
  return value >= 100 ? hc::format("{:.0f}", value) : hc::format("{:.3g}", value);
}

std::string cell(const Spread& spread, bool is_there = true) {
  if (!is_there) return hc::format("{:>9}{:>9}", "–", "–");
  return hc::format("{:>9}{:>9}", milliseconds(spread.median), milliseconds(spread.p99));
}

std::string table_of(const std::vector<PathSummary>& summaries, std::size_t messages) {
  constexpr std::string_view kHead = "  median and p99 [ms]";
  std::size_t widest = kHead.size();
  auto name_of = [](const Step& step) {
    return step.text() + (step.is_outside ? "  (outside)" : step.renews_time ? "  (new time)" : "");
  };
  // Counts characters: an arrow has three bytes.
  auto width_of = [](const std::string& text) {
    return static_cast<std::size_t>(
        std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
  };
  for (const auto& summary : summaries)
    for (const auto& step : summary.steps) widest = std::max(widest, width_of(name_of(step)) + 2);
  std::string text;
  for (std::size_t i = 0; i < std::min(summaries.size(), kMostPathsShown); ++i) {
    const auto& summary = summaries[i];
    const bool renews = std::ranges::any_of(summary.steps, &Step::renews_time);
    const std::string since =
        renews ? hc::format(", {} ms (p99 {}) since it was sensed",
                            milliseconds(summary.total.median), milliseconds(summary.total.p99))
               : "";
    const std::string title = hc::format(
        "{} of {}, {} ms old (p99 {}){}",
        summary.critical > 0 ? hc::format("critical path of {}", summary.critical)
                             : hc::format("path of {}, never critical,", summary.messages),
        messages, milliseconds(summary.age.median), milliseconds(summary.age.p99), since);
    text += (text.empty() ? "" : "\n") + title + "\n";
    text +=
        hc::format("{:<{}}{:>18}{:>18}{:>18}\n", kHead, widest, "link", "waiting", "processing");
    for (std::size_t k = 0; k < summary.steps.size(); ++k) {
      const auto& step = summary.steps[k];
      const auto& durations = summary.durations[k];
      const auto name = "  " + name_of(step);
      text += name + std::string(widest - width_of(name), ' ');
      text += cell(durations.link, k > 0 && !step.is_outside) +
              cell(durations.waiting, k > 0 && !step.is_outside) + cell(durations.processing) +
              "\n";
    }
  }
  if (summaries.size() > kMostPathsShown)
    text += hc::format("\nand {} more paths: --json\n", summaries.size() - kMostPathsShown);
  return text;
}

std::string json_of(const std::string& port, const std::vector<PathSummary>& summaries,
                    std::size_t messages, std::int64_t lost) {
  using nlohmann::json;
  auto pair = [](const Spread& spread) {
    return json{hc::seconds(spread.median), hc::seconds(spread.p99)};
  };
  json paths = json::array();
  for (const auto& summary : summaries) {
    json steps = json::array();
    for (std::size_t i = 0; i < summary.steps.size(); ++i) {
      const auto& step = summary.steps[i];
      const auto& durations = summary.durations[i];
      steps.push_back({{"module", step.module},
                       {"in", step.in},
                       {"out", step.out},
                       {"outside", step.is_outside},
                       {"renews_time", step.renews_time},
                       {"link", pair(durations.link)},
                       {"waiting", pair(durations.waiting)},
                       {"processing", pair(durations.processing)}});
    }
    paths.push_back({{"messages", summary.messages},
                     {"critical", summary.critical},
                     {"age", pair(summary.age)},
                     {"total", pair(summary.total)},
                     {"steps", std::move(steps)}});
  }
  return json{{"port", port}, {"messages", messages}, {"lost", lost}, {"paths", paths}}.dump() +
         "\n";
}

/// Takes the words [RECORDING] [MODULE.PORT].
void take_words(std::vector<std::string> words, TraceOptions& options) {
  using Kind = hc::record::Place::Kind;
  if (words.empty()) return;
  const auto kind = value_or_fail(hc::record::place_of(words.front())).kind;
  if (words.size() == 2 || kind == Kind::Mcap || kind == Kind::Folder) {
    options.recording = words.front();
    words.erase(words.begin());
  } else if (kind == Kind::File && is_recording_file(words.front())) {
    throw Failure(hc::Code::Invalid, words.front() +
                                         " has the messages of one stream; give the "
                                         "folder or FILE.mcap of hc run --record");
  }
  if (!words.empty()) options.port = words.front();
}

void trace(const TraceOptions& options) {
  if (options.port.empty() && options.perfetto.empty())
    throw Failure(hc::Code::Invalid, "give MODULE.PORT, or --perfetto FILE for all modules");
  const auto collected = options.recording.empty() ? collect(options) : read_recording(options);
  if (!options.perfetto.empty())
    if (auto written = hc::replace_file(options.perfetto, to_chrome_trace(collected.traced));
        !written)
      throw Failure(written.error());
  if (collected.lost > 0) say(hc::format("hc trace: {} events dropped: too many", collected.lost));
  if (options.port.empty()) return;
  const auto module = module_of(options.port);
  if (!collected.traced.events.contains(module))
    throw Failure(hc::Code::NotFound,
                  module + " sends no trace: it does not run, or takes no commands");
  const auto paths = find_paths(collected.traced, options.port);
  // Each message has at most one complete critical path.
  const auto messages = static_cast<std::size_t>(
      std::ranges::count_if(paths, [](const auto& path) { return path.is_critical; }));
  if (paths.empty())
    throw Failure(hc::Code::NotFound,
                  "no message of " + options.port + " could be traced to its origin");
  const auto summaries = summarise(paths);
  print(options.json ? json_of(options.port, summaries, messages, collected.lost)
                     : table_of(summaries, messages));
}

}  // namespace

void add_trace(CLI::App& app) {
  auto options = std::make_shared<TraceOptions>();
  options->graph.token = hc::graph_token();
  auto* verb = app.add_subcommand(
      "trace", "Show what messages were derived from, and how long each step took");
  auto words = std::make_shared<std::vector<std::string>>();
  verb->add_option("port", *words,
                   "MODULE.PORT of a running graph; or a recording, and a MODULE.PORT in it")
      ->expected(0, 2);
  add_of(*verb, options->of);
  verb->add_option("--duration", options->duration, "time to trace a running graph [s]")
      ->check(number_in(0.1, 3600));
  verb->add_option("--recording", options->recording,
                   "folder or .mcap of hc run --record, instead of a running graph");
  verb->add_option("--graph", options->graph.file,
                   "graph file of the recording, for modules that take no commands")
      ->transform(find_graph);
  verb->add_option("--perfetto", options->perfetto,
                   "write all events to this file (ui.perfetto.dev opens it)");
  verb->add_flag("--json", options->json, "print one line of JSON");
  verb->callback([options, words] {
    take_words(*words, *options);
    trace(*options);
  });
}

}  // namespace tool
