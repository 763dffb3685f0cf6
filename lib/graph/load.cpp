// SPDX-License-Identifier: Apache-2.0
#include <graph/load.h>

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <system_error>

#include <graph/added_modules.h>
#include <graph/held_port.h>
#include <graph/programs.h>
#include <hc/base/suggestion.h>
#include <hc/contract/description.h>
#include <hc/os/aside.h>

namespace hc {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kMorePatience{1};  // with the others, once a host has failed

Error cannot_read(const std::string& name, std::error_code why) {
  const bool is_missing = why == std::errc::no_such_file_or_directory;
  return {is_missing ? Code::NotFound : Code::System, name + ": cannot be read: " + why.message()};
}

Result<std::string> read_text(const std::string& name) {
  std::error_code missing;
  if (fs::is_directory(name, missing))
    return Error{Code::System, name + ": is a folder, not a file"};
  std::string text(kMaxGraphBytes + 1, '\0');
  std::ifstream file(name, std::ios::binary);
  if (file) file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!file.is_open() || file.bad()) return cannot_read(name, {errno, std::generic_category()});
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

/// Refuses pipes and devices, which could block. Errors have the absolute path.
Result<std::string> read_file(const std::string& name) {
  std::error_code why;
  const std::string path = fs::absolute(name, why).lexically_normal().string();
  const auto type = fs::status(path, why).type();
  if (why) return cannot_read(path, why);
  if (type != fs::file_type::regular && type != fs::file_type::directory)
    return Error{Code::System, path + ": cannot be read: not a file"};
  return read_text(path);
}

/// Finds a program. @param path  of it, if its name has a slash. Errors: NotFound, Stopped.
Result<std::string> path_of(const std::string& program, const std::string& path, int stop) {
  return unless_stopped(stop, [=]() -> Result<std::string> {
    auto found = find_program(path);
    if (found.empty()) return Error{Code::NotFound, no_program(program, path)};
    return found;
  });
}

class FileLoader : public GraphLoader {
 public:
  explicit FileLoader(LoadOptions options) : options_(std::move(options)) {}

  Result<LoadedGraph> load(const Plan* running, int stop) override {
    if (running != nullptr || options_.hosts == nullptr || options_.programs_here)
      return read_and_plan(running, stop);
    Result<LoadedGraph> loaded = Error{};
    auto served = options_.hosts->serve([&] { loaded = read_and_plan(nullptr, stop); });
    return served ? std::move(loaded) : served.error();
  }

  LoadedGraph plan(Graph graph, const Plan& running, int stop) override {
    Problems problems(graph.files);
    return planned(std::move(graph), problems, &running, stop);
  }

 private:
  using Answers = std::map<std::string, Result<std::string>>;  // by program

  /// The answers of another host.
  struct HostAnswer {
    Result<Hosts::Connected> connected;
    Answers found;      // paths, by program
    Answers described;  // descriptions, by path
  };
  using HostAnswers = std::map<std::string, HostAnswer>;

  Result<LoadedGraph> read_and_plan(const Plan* running, int stop) {
    // A reload reads regular files only: a pipe cannot be read twice.
    const auto text = HC_TRY(unless_stopped(
        stop, [file = options_.file, read = running == nullptr ? read_text : read_file] {
          return read(file);
        }));
    auto read_included = [stop](const std::string& name) {
      return unless_stopped(stop, [name] { return read_file(name); });
    };
    Problems problems(options_.file);
    auto environment = [](const char* name) -> const char* { return std::getenv(name); };
    Graph graph = parse_graph(text, environment, problems, read_included);
    if (options_.page) add_page(graph, options_.listen, problems);
    for (const auto& setting : options_.settings)
      if (const auto assignment = parse_assignment(setting))
        set_parameter(graph, *assignment, problems, kCommandLine);
      else
        problems.add(kCommandLine, assignment.error().detail);
    return planned(std::move(graph), problems, running, stop);
  }

  LoadedGraph planned(Graph graph, Problems& problems, const Plan* running, int stop) {
    HostAnswers remote;
    out_of_reach_ = 0;
    if (auto asked = options_.programs_here ? Status() : ask_hosts(graph, problems, stop, remote);
        !asked)
      problems.add({}, asked.error().text());
    HostPlaces places;
    if (options_.hosts != nullptr && !options_.programs_here)
      places[""].fingerprint = options_.hosts->fingerprint();
    for (const auto& [name, there] : remote) places[name] = there.connected->place;
    find_programs(graph, remote, problems, stop);
    Answers described;  // on this host; failures are not retried
    LoadedGraph loaded{graph, {}, {}, {}};
    std::string recorder;
    if (!options_.recorder.empty()) {
      const auto found = path_of("recorder", "recorder", stop);
      if (!found) problems.add({}, "--record: " + found.error().detail);
      recorder = found.value_or("");
    }
    std::vector<std::string> recorded;
    auto describe = [&](const std::string& program,
                        const std::string& host) -> Result<std::string> {
      if (!host.empty() && !options_.programs_here) return remote.at(host).described.at(program);
      auto known = described.find(program);
      if (known == described.end())
        known = described.emplace(program, describe_once(program, stop)).first;
      if (program == recorder && known->second) return with_inputs(*known->second, recorded);
      return known->second;
    };
    if (!recorder.empty()) {
      recorded =
          add_recorder(graph, recorded_unlinked(graph, describe), recorder, options_.recorder);
      loaded.recorder = graph.modules.back().name;
    }
    auto hold_port = [&](const std::string& host, bool is_for_others) {
      return host.empty() ? hc::hold_port(is_for_others)
                          : remote.at(host).connected->host->hold_port(is_for_others, stop);
    };
    Plan plan = make_plan(std::move(graph), describe, options_.token, problems, running,
                          options_.holds_ports ? hold_port : HoldPort(), places);
    loaded.problems = problems.lines();
    loaded.awaits_hosts = out_of_reach_ > 0 && problems.size() == out_of_reach_;
    if (problems.empty()) loaded.plan = std::move(plan);
    return loaded;
  }

  /// Replaces names of programs by absolute paths, which stay the same in a later plan; a name with
  /// a slash is relative to its graph file. Modules on an unreachable host cause no further
  /// problems.
  void find_programs(Graph& graph, const HostAnswers& remote, Problems& problems, int stop) const {
    for (auto& module : graph.modules) {
      auto& [program, place] = module.program;
      const std::string given = std::exchange(program, {}), &host = module.host.value;
      if (given.empty()) continue;  // already reported
      if (const auto there = remote.find(host); there != remote.end()) {
        const auto& path = there->second.found.at(given);
        if (!path) problems.add(place, "host {}: {}", host, path.error().detail);
        program = path.value_or("");
      } else if (host.empty() || options_.programs_here) {
        std::string name = given;
        if (name.find('/') != std::string::npos && !name.starts_with('/'))
          name = fs::absolute(fs::path(problems.file(place.file)).parent_path() / name)
                     .lexically_normal()
                     .string();
        const auto path = path_of(given, name, stop);
        if (!path) problems.add(place, path.error().detail);
        program = path.value_or("");
      }
    }
  }

  static HostAnswer ask_host(Hosts& hosts, const GraphHost& declared,
                             const std::set<std::string>& programs, int stop) {
    HostAnswer there{hosts.connect(declared, stop), {}, {}};
    for (const auto& program : programs) {
      if (!there.connected) break;
      auto& host = *there.connected->host;
      auto path = host.find_program(program, stop);
      if (path) there.described.emplace(*path, host.describe_program(*path, stop));
      there.found.emplace(program, std::move(path));
    }
    return there;
  }

  /// Connects to all hosts in parallel and asks for the paths and descriptions of their programs.
  /// Problems: an unreachable host; the others then have kMorePatience to answer.
  ///
  /// Errors: Stopped, System.
  Status ask_hosts(const Graph& graph, Problems& problems, int stop, HostAnswers& remote) {
    const auto loop = HC_TRY(Loop::make());
    std::vector<Aside> asked;
    std::size_t answers = 0;
    Loop::Handle patience;
    auto give_up = [&asked] {
      for (auto& each : asked) each.stop();
    };
    for (const auto& declared : graph.hosts) {
      std::set<std::string> programs;
      for (const auto& module : graph.modules)
        if (module.host.value == declared.name) programs.insert(module.program.value);
      if (declared.ssh.empty() || programs.empty()) continue;
      if (options_.hosts == nullptr) {
        problems.add(declared.place, "this program runs graphs on one host only");
        break;
      }
      programs.erase("");  // already reported
      auto answered = [&, &declared = declared, number = asked.size()](HostAnswer there) {
        ++answers;
        if (asked[number].is_stopped()) return;
        if (there.connected) {
          remote.emplace(declared.name, std::move(there));
          return;
        }
        problems.add(declared.place, "host {}: {}", declared.name, there.connected.error().detail);
        if (there.connected.error().code == Code::NotFound) ++out_of_reach_;
        if (patience) return;
        patience = loop->call_at(std::chrono::steady_clock::now() + kMorePatience, give_up);
      };
      asked.push_back(HC_TRY(run_aside(
          *loop,
          [=, &declared = declared, this](int given_up) {
            return ask_host(*options_.hosts, declared, programs, given_up);
          },
          answered)));
    }
    bool is_stopped = false;
    const auto stopped = HC_TRY(loop->watch(stop, stop < 0 ? 0U : EPOLLIN | EPOLLET, [&](auto) {
      is_stopped = true;
      give_up();
    }));
    while (answers < asked.size()) HC_TRY(loop->turn());
    if (is_stopped) return Error{Code::Stopped, "asked to stop"};
    return {};
  }

  Result<std::string> describe_once(const std::string& program, int stop) {
    const auto stamp = HC_TRY(unless_stopped(stop, [program]() -> Result<Stamp> {
      std::error_code missing;
      return Stamp(fs::last_write_time(program, missing), fs::file_size(program, missing));
    }));
    auto known = described_.find(program);
    if (known != described_.end() && known->second.stamp == stamp) return known->second.description;
    auto description = describe_program(program, stop);
    if (description) described_[program] = {stamp, *description};
    return description;
  }

  using Stamp = std::pair<fs::file_time_type, std::uintmax_t>;  // time of last change, size
  struct Described {
    Stamp stamp;
    std::string description;
  };

  LoadOptions options_;
  std::size_t out_of_reach_ = 0;                // hosts, of the last graph
  std::map<std::string, Described> described_;  // by program
};

}  // namespace

std::string graph_token() {
  // A process may run two graphs, and PIDs are reused.
  return "hc-" + std::to_string(::getpid()) + "-" +
         std::to_string(std::chrono::steady_clock::now().time_since_epoch().count());
}

std::unique_ptr<GraphLoader> make_loader(LoadOptions options) {
  return std::make_unique<FileLoader>(std::move(options));
}

}  // namespace hc
