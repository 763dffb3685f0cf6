// SPDX-License-Identifier: Apache-2.0
// Records all that comes, into MCAP or a folder. `hc run --record FILE.mcap` adds it to a graph,
// with an input for each output that it records, and `--record FOLDER` where modules run on other
// hosts.
#include <csignal>
#include <cstdlib>
#include <filesystem>

#include <sys/signalfd.h>

#include <hc/base/format.h>
#include <hc/module/module.h>
#include <hc/os/descriptor.h>

#include "folder_recorder.h"
#include "graph_metadata.h"

namespace {

constexpr std::string_view kStreams = "--streams";

struct StreamName {
  std::string input, name;
};

/// Inputs and names of streams, "INPUT=NAME INPUT=NAME …"; one input where there are none.
std::vector<StreamName> stream_names(int argc, char** argv) {
  std::vector<StreamName> names;
  for (int i = 1; i < argc; ++i) {
    std::string_view words(argv[i]);
    if (!words.starts_with(kStreams)) continue;
    words.remove_prefix(kStreams.size());
    if (words.empty() && i + 1 < argc)
      words = argv[++i];
    else if (words.starts_with('='))
      words.remove_prefix(1);
    else
      continue;
    while (!words.empty()) {
      const auto word = words.substr(0, words.find(' '));
      words.remove_prefix(std::min(words.size(), word.size() + 1));
      if (const auto equals = word.find('='); equals != std::string_view::npos)
        names.push_back(
            {std::string(word.substr(0, equals)), std::string(word.substr(equals + 1))});
    }
  }
  if (names.empty()) names.push_back({"in", "in"});
  return names;
}

std::uint64_t bytes_of(const std::string& parameter, const std::string& text) {
  const auto bytes = hc::mcap::parse_bytes(text);
  if (!bytes)
    throw hc::ModuleError(hc::Error{bytes.error().code, parameter + ": " + bytes.error().detail});
  return *bytes;
}

/// A file that is not there yet: the module may have been restarted.
std::string free_name(const std::string& file) {
  const std::filesystem::path path(file);
  std::string name = file;
  std::error_code missing;
  for (int i = 2; std::filesystem::exists(name, missing); ++i)
    name = std::filesystem::path(path).replace_filename(
        hc::format("{}_{}{}", path.stem().string(), i, path.extension().string()));
  return name;
}

}  // namespace

int main(int argc, char** argv) {
  // A signal saves; it is read from a descriptor. Files that become too large are an error.
  ::signal(SIGXFSZ, SIG_IGN);
  sigset_t saves;
  ::sigemptyset(&saves);
  ::sigaddset(&saves, SIGUSR1);
  ::pthread_sigmask(SIG_BLOCK, &saves, nullptr);
  const hc::internal::Descriptor signals(::signalfd(-1, &saves, SFD_NONBLOCK | SFD_CLOEXEC));

  hc::Module module{"recorder",
                    "Records streams into a file of MCAP, which viewers read, or into a folder."};
  const auto names = stream_names(argc, argv);
  std::vector<hc::Input<hc::AnyKind>> inputs;
  inputs.reserve(names.size());
  for (const auto& [input, name] : names)
    inputs.push_back(module.input(input, hc::anything(), "recorded as " + name));
  auto file = module.parameter("file", "", "", "output file, of MCAP", {.fixed = true});
  auto folder = module.parameter("folder", "", "",
                                 "in place of `file`: a file STREAM.mtp for each stream goes there",
                                 {.fixed = true});
  auto streams = module.parameter(
      "streams", "", "", "inputs and names of their streams, INPUT=NAME …", {.fixed = true});
  auto split = module.parameter(
      "split", "0", "", "a new file begins after so many bytes (1G); 0: never", {.fixed = true});
  auto keep = module.parameter(
      "keep", "0", "", "of all files, the oldest are removed (10G); 0: all stay", {.fixed = true});
  auto last = module.parameter(
      "last", 0.0, "s",
      "keep the last seconds in memory, and write them on SIGUSR1, or when `when` says so; 0: off",
      {.fixed = true});
  auto when = module.parameter("when", "", "",
                               "MODULE.PORT: saves when its first number becomes other than 0",
                               {.fixed = true});
  auto frames = module.parameter("frames", "", "", "frames of the graph, as text", {.fixed = true});

  std::unique_ptr<hc::mcap::Recorder> recorder;
  std::unique_ptr<FolderRecorder> folder_recorder;  // one of the two
  std::unique_ptr<GraphMetadata> metadata;
  std::string path;
  bool has_failed = false, was_set = false;
  std::uint64_t unrecorded = 0;

  auto close = [&] { return recorder ? recorder->close() : folder_recorder->close(); };
  auto fail_once = [&](const hc::Status& status) {
    if (status || has_failed) return;
    has_failed = true;
    static_cast<void>(close());
    module.log("error: recording ended: " + status.error().detail + "; " + path +
               " holds what came before");
  };
  auto save = [&] {
    auto saved = recorder->save();
    module.log(saved ? "saved " + *saved : "error: not saved: " + saved.error().detail);
  };

  module.on_start([&] {
    hc::mcap::RecorderOptions options;
    options.split = bytes_of("split", *split);
    options.keep = bytes_of("keep", *keep);
    options.last =
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(*last));
    if (file->empty() == folder->empty())
      throw hc::ModuleError(hc::Error{hc::Code::Invalid, "give either `file` or `folder`"});
    if (!folder->empty()) {
      if (options.split > 0 || options.keep > 0 || *last > 0 || !when->empty())
        throw hc::ModuleError(
            hc::Error{hc::Code::Invalid, "`split`, `keep`, `last` and `when` are for `file`"});
      std::vector<std::string> streams_of_folder;
      streams_of_folder.reserve(names.size());
      for (const auto& [input, name] : names) streams_of_folder.push_back(name);
      folder_recorder = hc::value_or_end(FolderRecorder::make(*folder, streams_of_folder));
      path = folder_recorder->folder();
      return;
    }
    options.file = options.split == 0 && *last == 0 ? free_name(*file) : *file;
    path = options.file;
    recorder = hc::value_or_end(hc::mcap::Recorder::make(options));
    if (auto named = recorder->set_frames(*frames, module.now()); !named)
      throw hc::ModuleError(named.error());
    for (const auto& [input, name] : names) recorder->add_stream(name);
    metadata = GraphMetadata::observe(std::getenv("HC_GRAPH"));
  });
  for (std::size_t i = 0; i < inputs.size(); ++i)
    module.on_raw(inputs[i], [&, i](const hc::Message& message) {
      if (has_failed) {
        ++unrecorded;
        return;
      }
      fail_once(recorder ? recorder->record(i, message, module.now())
                         : folder_recorder->record(i, message));
      if (names[i].name != *when || *last == 0) return;
      const bool is_set = message.plain() && !message.elements.empty() &&
                          hc::visit_scalar(message.header.info.scalar, [&](auto zero) {
                            return message.view<decltype(zero)>()->numbers().front() != zero;
                          });
      if (is_set && !was_set) save();
      was_set = is_set;
    });
  module.on_readable([&] { return signals.get(); },
                     [&] {
                       signalfd_siginfo info{};
                       while (::read(signals.get(), &info, sizeof info) > 0)
                         if (recorder != nullptr) save();
                     });
  module.on_readable(
      [&] { return metadata != nullptr && !has_failed ? metadata->descriptor() : -1; },
      [&] { metadata->record(*recorder, module.now()); });
  module.every(std::chrono::milliseconds(250), [&] {
    if (metadata != nullptr && !has_failed) metadata->record(*recorder, module.now());
    if (recorder != nullptr && !has_failed) fail_once(recorder->poll());
  });
  module.finish_when_stopped();
  module.on_end([&] {
    metadata.reset();
    if (!has_failed) fail_once(close());
    const std::uint64_t lost = recorder ? recorder->lost() : folder_recorder->lost();
    const std::uint64_t recorded =
        (recorder ? recorder->messages() : folder_recorder->messages()) - lost;
    std::string text =
        hc::format("result: {} message{} in {}", recorded, recorded == 1 ? "" : "s", path);
    if (has_failed) text += hc::format(", {} not recorded", unrecorded + lost);
    module.log(text);
  });
  return module.run(argc, argv);
}
