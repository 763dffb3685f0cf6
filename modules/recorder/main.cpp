// SPDX-License-Identifier: Apache-2.0
// Records all that comes, into MCAP or a folder. `hc run --record FILE.mcap` adds it to a graph,
// with an input for each output that it records, and `--record FOLDER` where modules run on other
// hosts.
#include <csignal>

#include <sys/signalfd.h>

#include <client/running.h>
#include <hc/base/format.h>
#include <hc/module/module.h>
#include <hc/os/descriptor.h>
#include <transports/all.h>

#include "folder_recording.h"
#include "mcap_recording.h"

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

[[noreturn]] void refuse(const std::string& what) {
  throw hc::ModuleError(hc::Error{hc::Code::Invalid, what});
}

std::uint64_t bytes_of(const std::string& parameter, const std::string& text) {
  const auto bytes = hc::mcap::parse_bytes(text);
  if (!bytes)
    throw hc::ModuleError(hc::Error{bytes.error().code, parameter + ": " + bytes.error().detail});
  return *bytes;
}

}  // namespace

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"recorder",
                    "Records streams into a file of MCAP, which viewers read, or into a folder."};
  sigset_t saves;  // a signal that is read from a descriptor
  ::sigemptyset(&saves);
  ::sigaddset(&saves, SIGUSR1);
  ::pthread_sigmask(SIG_BLOCK, &saves, nullptr);
  const hc::internal::Descriptor signals(::signalfd(-1, &saves, SFD_NONBLOCK | SFD_CLOEXEC));

  const auto names = stream_names(argc, argv);
  std::vector<hc::Input<hc::AnyKind>> inputs;
  std::vector<std::string> recorded;  // their names
  for (const auto& [input, name] : names) {
    inputs.push_back(module.input(input, hc::anything(), "recorded as " + name));
    recorded.push_back(name);
  }
  auto file = module.parameter(
      "file", "", "", "output file, of MCAP; recording.mcap where neither it nor `folder` is given",
      {.fixed = true});
  auto folder = module.parameter(
      "folder", "", "", "record into this folder instead of `file`, one STREAM.mtp for each stream",
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

  std::unique_ptr<Recording> recording;  // null: before the start
  bool has_failed = false;
  std::uint64_t unrecorded = 0;
  auto fail_once = [&](const hc::Status& status) {
    if (status || has_failed) return;
    has_failed = true;
    static_cast<void>(recording->close());
    module.log("recording ended: " + status.error().detail + "; " + recording->place() +
                   " holds what came before",
               hc::Level::Error);
  };

  module.on_start([&] {
    McapOptions options;
    options.file = file->empty() ? "recording.mcap" : *file;
    options.split = bytes_of("split", *split);
    options.keep = bytes_of("keep", *keep);
    options.last =
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(*last));
    options.when = *when;
    options.frames = *frames;
    const bool is_folder = !folder->empty();
    if (is_folder && !file->empty()) refuse("give either `file` or `folder`");
    if (is_folder && (options.split > 0 || options.keep > 0 || *last > 0 || !when->empty()))
      refuse("`split`, `keep`, `last` and `when` are for `file`");
    recording = hc::value_or_end(is_folder ? open_folder(*folder, recorded)
                                           : open_mcap(module, options, recorded));
    if (const auto& place = recording->place(); place != (is_folder ? *folder : options.file))
      module.log("recording continues in " + place);
  });
  for (std::size_t i = 0; i < inputs.size(); ++i)
    module.on_raw(inputs[i], [&, i](const hc::Message& message) {
      if (has_failed)
        ++unrecorded;
      else
        fail_once(recording->record(i, message));
    });
  auto poll = [&] {
    if (!has_failed) fail_once(recording->poll());
  };
  module.on_readable(
      [&] { return recording != nullptr && !has_failed ? recording->descriptor() : -1; }, poll);
  module.every(std::chrono::milliseconds(250), poll);
  module.on_readable([&] { return signals.get(); },
                     [&] {
                       signalfd_siginfo info{};
                       while (::read(signals.get(), &info, sizeof info) > 0)
                         if (recording != nullptr) recording->save();
                     });
  module.finish_when_stopped();
  module.on_end([&] {
    if (!has_failed) fail_once(recording->close());
    const std::uint64_t lost = recording->lost(), count = recording->messages() - lost;
    std::string text =
        hc::format("{} message{} in {}", count, count == 1 ? "" : "s", recording->place());
    if (has_failed) text += hc::format(", {} not recorded", unrecorded + lost);
    module.log(text, hc::Level::Result);
  });
  const int status = module.run(argc, argv);
  // In a graph it lasts as long as that, which says at its end what is missing.
  return status == 0 && has_failed && !hc::own_graph() ? 1 : status;
}
