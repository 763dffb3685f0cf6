// SPDX-License-Identifier: Apache-2.0
// hc run: runs a graph.
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

#include <graph/run.h>
#include <hc/base/format.h>
#include <hc/os/first_process.h>
#include <hc/os/program.h>
#include <hc/os/secret.h>
#include <hc/os/wait_readable.h>
#include <record/place.h>

#include "common.h"
#include "graph.h"
#include "observer.h"
#include "outbox.h"
#include "screen.h"
#include "verbs.h"

namespace tool {
namespace {

struct RunOptions {
  hc::LoadOptions graph;
  std::string name;
  bool quiet = false, links = false;
  std::string record;                           // folder, or file of MCAP
  std::map<std::string, std::string> recorder;  // parameters of the module `recorder`
};

/// Set by SIGUSR1: save the messages kept by --last.
volatile std::sig_atomic_t save_recording = 0;

/// Prints a few lines about the run, including the modules' results.
void print_summary(const RunOptions& options, const hc::RunReport& report) {
  hc::Traffic sum;
  std::uint64_t restarts = 0, ignored = 0;
  for (const auto& link : report.state.links) {
    sum += link.traffic;
    ignored += link.ignored;
  }
  for (const auto& module : report.state.modules)
    restarts += static_cast<std::uint64_t>(module.restarts);
  std::string text = hc::format("{} ran for {}: {}{}, {} ({})\n", options.graph.file,
                                seconds_in_words(report.state.uptime),
                                counted(report.state.modules.size(), "module"),
                                restarts > 0 ? ", " + counted(restarts, "restart") : "",
                                counted(sum.messages, "message"), bytes_in_words(sum.bytes));
  for (const auto& line : report.results) text += "  " + line.line() + "\n";
  std::vector<std::string> lost;
  for (auto [count, word] : {std::pair(sum.throttled, "throttled"),
                             {sum.lost() - sum.throttled, "dropped"},
                             {ignored, "ignored out of focus"}})
    if (count > 0) lost.push_back(hc::format("{} {}", count, word));
  if (!lost.empty())
    text += "  " + joined(lost) + (options.links ? "\n" : " (--links: at which links)\n");
  print(text);
}

void print_links(const hc::GraphState& state) {
  std::size_t widest = 0;
  for (const auto& link : state.links)
    widest = std::max(widest, link.from.size() + link.to.size() + 5);
  std::string text;
  for (const auto& link : state.links) {
    std::string name = link.from + " → " + link.to;
    const auto& sent = link.traffic;
    text += hc::format("{:<{}}  {:>8} message{}  {:>9}{}\n", name, widest, sent.messages,
                       sent.messages == 1 ? " " : "s", bytes_in_words(sent.bytes),
                       sent.lost() > 0 ? "  " + losses_in_words(sent) : "");
  }
  print(text);
}

/// The graph's name; only letters, digits, `_` and `-`.
std::string name_of(const RunOptions& options) {
  std::string name = options.name.empty()
                         ? std::filesystem::path(options.graph.file).stem().string()
                         : options.name;
  name.resize(std::min(name.size(), hc::kMaxGraphName));
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !hc::is_of_graph_name(c); }, '_');
  return name.empty() ? "graph" : name;
}

/// A name given with --as must be unique; a file's name is made unique by the PID.
void check_name(const RunOptions& options) {
  const auto name = name_of(options);
  for (const auto& graph : find_running()) {
    if (graph.name != name) continue;
    if (!options.name.empty())
      throw Failure(hc::Code::Invalid, "--as " + name + ": " + graph.text() + " is running");
    if (!options.quiet && ::isatty(STDERR_FILENO) == 1)
      say(hc::format("hc run: {} is already running; this one is {}.{} (--as gives it a name)",
                     graph.text(), name, ::getpid()));
    return;
  }
}

/// Fails if the folder is not writable, before any module starts.
void check_writable(const std::filesystem::path& folder, std::error_code failed) {
  const auto path = folder.empty() ? "." : folder.string();
  if (!failed && ::access((path + "/").c_str(), W_OK | X_OK) != 0)
    failed.assign(errno, std::generic_category());
  if (failed) throw Failure(hc::Code::System, path + ": " + failed.message());
}

/// Sets the parameters of the module `recorder`. An earlier recording stays unchanged.
void take_record(const RunOptions& options, hc::LoadOptions& load) {
  if (options.record.empty()) return;
  for (const auto& [name, value] : options.recorder)
    if (!value.empty())
      load.recorder[name] =
          name == "last" && value.ends_with('s') ? value.substr(0, value.size() - 1) : value;
  const bool is_numbered = load.recorder.contains("split") || load.recorder.contains("last");
  const auto given = value_or_fail(hc::record::place_of_streams(options.record), "--record");
  const bool is_mcap = given.kind == hc::record::Place::Kind::Mcap;
  if (!is_mcap && !load.recorder.empty())
    throw Failure(hc::Code::Invalid, "--" + load.recorder.begin()->first +
                                         " is for recordings in MCAP: --record FILE.mcap");
  const auto place = hc::record::free_place(given, is_numbered);
  std::error_code failed;
  if (!is_mcap) std::filesystem::create_directories(place.path, failed);
  const std::filesystem::path path(place.path);
  check_writable(is_mcap ? path.parent_path() : path, failed);
  load.recorder[is_mcap ? "file" : "folder"] = place.path;
  if (!is_mcap) load.recorder["append"] = "true";  // a restarted recorder continues
  if (is_mcap) std::signal(SIGUSR1, [](int) { save_recording = 1; });
  if (place.path != given.path)
    say(hc::format("hc run: {} stays as it is; recording to {}", given.path, place.path));
}

/// Loads the graph, as soon as its hosts are there: they may start later than this one.
hc::LoadedGraph load_when_hosts_answer(hc::GraphLoader& loader, const std::string& file) {
  constexpr std::chrono::seconds kPause{1};
  std::error_code unknown;
  const bool is_read_again = std::filesystem::is_regular_file(file, unknown);  // not a pipe
  std::vector<std::string> said;
  while (true) {
    auto loaded = loader.load(nullptr, said.empty() ? -1 : hc::stop_descriptor());
    if (!loaded || !loaded->awaits_hosts || !is_read_again)
      return without_problems("run", file, std::move(loaded));
    const int stop = hc::stop_descriptor();  // before the message, after which one may stop it
    if (std::exchange(said, loaded->problems) != loaded->problems)
      for (const auto& line : loaded->problems)
        say(hc::format("hc run: {}; trying again until it answers", line));
    if (auto waited = hc::wait_readable({}, stop, kPause); !waited) throw Failure(waited.error());
  }
}

/// Logs the error through the outbox, as its reader may have stopped reading.
[[noreturn]] void fail(Outbox& lines, const hc::Error& error) {
  lines.say("hc run: " + error.text());
  throw Failure(Failure(error).status);
}

void run(RunOptions options) {
  hc::leave_first_process();
  allow_descriptors();
  check_name(options);
  hc::LoadOptions load_options = options.graph;
  take_record(options, load_options);
  load_options.holds_ports = true;
  // Programs started by modules, such as `hc`, use this graph. No thread reads the environment yet.
  ::setenv(hc::kRunSecret, hc::make_secret().c_str(), 1);
  ::setenv("HC_GRAPH", (name_of(options) + "." + std::to_string(::getpid())).c_str(), 1);
  const auto hosts = make_hosts();
  load_options.hosts = hosts.get();
  auto loader = hc::make_loader(load_options);
  auto graph = load_when_hosts_answer(*loader, options.graph.file);
  Outbox lines(STDERR_FILENO);
  const bool has_status = !options.quiet && ::isatty(STDERR_FILENO) == 1;
  if (const auto& unlinked = graph.plan->unlinked; !options.record.empty() && !unlinked.empty()) {
    lines.say("graph: unlinked outputs are not recorded: " + joined(unlinked) +
              "; hc record MODULE.PORT FILE records one");
  }
  hc::RunOptions run_options;
  run_options.stop = hc::stop_descriptor();
  run_options.with_module_lines = !options.quiet;
  run_options.event = [&](const hc::LogLine& line) {
    if (!options.quiet || line.level != hc::Level::Info) lines.say(line.line());
  };
  run_options.state = [&, recorder = graph.recorder](const hc::GraphState& state) {
    if (has_status) lines.show(status_line(state).substr(0, terminal_size().width - 1));
    if (std::exchange(save_recording, 0) == 0) return;
    for (const auto& module : state.modules)
      if (module.name == recorder && module.process > 0) ::kill(module.process, SIGUSR1);
  };
  run_options.name = name_of(options);
  run_options.file = options.graph.file;
  run_options.loader = loader.get();
  run_options.hosts = hosts.get();
  auto report = hc::run_graph(std::move(graph), run_options);
  lines.finish();
  if (!report) fail(lines, report.error());
  print_summary(options, *report);
  if (options.links) print_links(report->state);
  std::vector<std::string> given_up;
  for (const auto& module : report->state.modules)
    if (module.status == hc::ModuleStatus::GivenUp) given_up.push_back(module.name);
  if (!given_up.empty()) fail(lines, {hc::Code::Closed, "given up: " + joined(given_up)});
  if (report->has_errors()) throw Failure(1);  // printed in the summary
}

}  // namespace

void add_run(CLI::App& app) {
  auto options = std::make_shared<RunOptions>();
  auto* verb = app.add_subcommand("run", "Run a graph of modules");
  add_graph_options(*verb, options->graph);
  verb->add_option("--as", options->name, "name of the running graph (default: the file's)");
  auto* record = verb->add_option(
      "--record", options->record,
      "record linked outputs, and those of modules at the end of the graph, into this folder, as "
      "MODULE.PORT.mtp, or into one FILE.mcap");
  for (const auto& [name, text] :
       {std::pair("split", "begin a new .mcap file after this many bytes (1G)"),
        {"keep", "remove the oldest of these files above this many bytes (10G)"},
        {"last", "keep the last seconds in memory, and save them on SIGUSR1"},
        {"when", "MODULE.PORT: save them when its first number becomes non-zero"}})
    verb->add_option(std::string("--") + name, options->recorder[name], text)->needs(record);
  auto* page = verb->add_flag("--page", options->graph.page,
                              "serve a page, print its URL, and open it if there is a desktop");
  verb->add_option("--listen", options->graph.listen,
                   "address for the page that other machines can reach, with TLS; 0.0.0.0: all")
      ->needs(page);
  verb->add_flag("--quiet", options->quiet, "log errors only");
  verb->add_flag("--links", options->links, "at the end, print the messages of each link");
  verb->callback([options, record] {
    if (record->count() > 0 && options->record.empty())
      throw Failure(hc::Code::Invalid, "--record takes a folder or FILE.mcap, not \"\"");
    run(*options);
  });
}

}  // namespace tool
