// SPDX-License-Identifier: Apache-2.0
// Records messages to MCAP or a folder. `hc run --record` adds it to a graph, with an input for
// each recorded output.
#include <sys/signalfd.h>
#include <unistd.h>

#include <csignal>
#include <optional>
#include <sstream>

#include <client/running.h>
#include <hc/base/format.h>
#include <hc/module/module.h>
#include <record/writer.h>
#include <transports/all.h>

#include "graph_metadata.h"

namespace {

struct StreamName {
  std::string input, name;
};

/// Inputs and names of streams, "INPUT=NAME INPUT=NAME …"; by default one input.
std::vector<StreamName> stream_names(int argc, char** argv) {
  constexpr std::string_view kStreams = "--streams";
  std::string all;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word(argv[i]);
    if (word == kStreams && i + 1 < argc)
      all.append(argv[++i]).append(" ");
    else if (word.starts_with(kStreams) && word.substr(kStreams.size()).starts_with('='))
      all.append(word.substr(kStreams.size() + 1)).append(" ");
  }
  std::vector<StreamName> names;
  std::istringstream words(all);
  for (std::string word; words >> word;)
    if (const auto equals = word.find('='); equals != std::string::npos)
      names.push_back({word.substr(0, equals), word.substr(equals + 1)});
  if (names.empty()) names.push_back({"in", "in"});
  return names;
}

/// The module's clock, which is the messages' time with --clock.
class ModuleClock final : public hc::Clock {
 public:
  explicit ModuleClock(const hc::Module& module) : module_(module) {}
  [[nodiscard]] hc::MonotonicTime monotonic() const override { return module_.monotonic(); }
  [[nodiscard]] std::int64_t wall() const override { return module_.now(); }

 private:
  const hc::Module& module_;
};

[[noreturn]] void refuse(const std::string& what) {
  throw hc::ModuleError(hc::Error{hc::Code::Invalid, what});
}

std::uint64_t bytes_of(const std::string& parameter, const std::string& text) {
  const auto bytes = hc::mcap::parse_bytes(text);
  if (!bytes) refuse(parameter + ": " + bytes.error().detail);
  return *bytes;
}

}  // namespace

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"recorder", "Records streams into an MCAP file or a folder.", {.finish_when_stopped = true}};
  sigset_t saves;  // SIGUSR1, read from a descriptor
  ::sigemptyset(&saves);
  ::sigaddset(&saves, SIGUSR1);
  ::pthread_sigmask(SIG_BLOCK, &saves, nullptr);
  const int signals = ::signalfd(-1, &saves, SFD_NONBLOCK | SFD_CLOEXEC);

  const auto names = stream_names(argc, argv);
  std::vector<hc::Input<hc::AnyKind>> inputs;
  std::vector<std::string> recorded;  // their names
  for (const auto& [input, name] : names) {
    inputs.push_back(module.input(input, hc::anything(), "recorded as " + name));
    recorded.push_back(name);
  }
  auto file = module.parameter(
      "file", "", "", "output file in MCAP format; default recording.mcap unless `folder` is given",
      {.fixed = true});
  auto folder = module.parameter(
      "folder", "", "", "record into this folder instead of `file`, one STREAM.mtp for each stream",
      {.fixed = true});
  auto append = module.parameter("append", false, "",
                                 "append to existing files in `folder`, as when a graph resumes",
                                 {.fixed = true});
  auto streams = module.parameter(
      "streams", "", "", "inputs and names of their streams, INPUT=NAME …", {.fixed = true});
  auto split = module.parameter("split", "0", "",
                                "size of a file in bytes at which a new one begins (1G); 0: never",
                                {.fixed = true});
  auto keep = module.parameter(
      "keep", "0", "", "maximum size of all files, the oldest are removed (10G); 0: unlimited",
      {.fixed = true});
  auto last = module.parameter(
      "last", 0.0, "s",
      "keep the last seconds in memory, and write them on SIGUSR1 or by `when`; 0: off",
      {.fixed = true});
  auto when = module.parameter("when", "", "",
                               "MODULE.PORT: saves when its first number becomes other than 0",
                               {.fixed = true});
  auto frames = module.parameter("frames", "", "", "frames of the graph, as text", {.fixed = true});

  const ModuleClock clock(module);
  std::unique_ptr<hc::record::Writer> recording;  // null: before the start
  const auto loop = hc::value_or_end(hc::Loop::make());
  std::optional<GraphMetadata> metadata;
  std::optional<hc::GraphClient> graph;  // none: not in a graph, or not recorded
  bool has_failed = false;
  auto fail_once = [&](const hc::Status& status) {
    if (status || std::exchange(has_failed, true)) return;
    module.log("recording ended: " + status.error().detail + "; " + recording->written().place +
                   " holds all messages before",
               hc::Level::Error);
  };

  module.on_start([&] {
    hc::record::WriterOptions options;
    options.streams = recorded;
    options.append = *append;
    options.frames = *frames;
    options.split = bytes_of("split", *split);
    options.keep = bytes_of("keep", *keep);
    options.last = hc::duration(*last);
    options.when = *when;
    options.clock = &clock;
    options.log = [&](hc::Level severity, std::string_view line) {
      module.log(std::string(line),
                 severity == hc::Level::Error ? hc::Level::Error : hc::Level::Info);
    };
    const bool is_folder = !folder->empty();
    if (is_folder && !file->empty()) refuse("give either `file` or `folder`");
    if (is_folder && (options.split > 0 || options.keep > 0 || *last > 0 || !when->empty()))
      refuse("`split`, `keep`, `last` and `when` are for `file`");
    hc::record::Place place;
    place.kind = is_folder ? hc::record::Place::Kind::Folder : hc::record::Place::Kind::Mcap;
    place.path = is_folder ? *folder : file->empty() ? "recording.mcap" : *file;
    recording = hc::value_or_end(hc::record::Writer::open(place, options));
    if (const auto& now = recording->written().place; now != place.path)
      module.log("recording continues in " + now);
    if (const auto own = hc::own_graph(); own && !is_folder)
      metadata.emplace(graph.emplace(*loop, *own), *recording);
  });
  for (std::size_t i = 0; i < inputs.size(); ++i)
    module.on_raw(inputs[i],
                  [&, i](const hc::Message& message) { fail_once(recording->add(i, message)); });
  module.on_readable([&] { return has_failed ? -1 : loop->descriptor(); },
                     [&] { hc::succeed_or_end(loop->turn(std::chrono::milliseconds(0))); });
  module.on_readable([&] { return signals; },
                     [&] {
                       signalfd_siginfo info{};
                       while (::read(signals, &info, sizeof info) > 0)
                         if (recording != nullptr) recording->save();
                     });
  module.on_end([&] {
    graph.reset();
    const auto& written = recording->close();
    fail_once(written.status);
    if (written.files.empty()) return module.log("nothing saved", hc::Level::Result);
    std::string text = hc::format("{} message{} in {}", written.messages,
                                  written.messages == 1 ? "" : "s", written.place);
    if (written.files.size() > 1 && folder->empty())
      text += hc::format(", in {} files", written.files.size());
    if (written.lost > 0) text += hc::format(", {} not recorded", written.lost);
    module.log(text, hc::Level::Result);
  });
  const int status = module.run(argc, argv);
  // In a graph a failed recorder keeps running, and the graph reports the failure at its end.
  return status == 0 && has_failed && !hc::own_graph() ? 1 : status;
}
