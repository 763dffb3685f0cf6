// SPDX-License-Identifier: Apache-2.0
#include "diagnosis.h"

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <limits>

#include <hc/base/format.h>
#include <hc/base/uri.h>

namespace tool {
namespace {

constexpr std::uint64_t kFewDescriptors = 1024;
constexpr std::uint64_t kFewProcesses = 256;
constexpr std::uint64_t kLittleMemory = std::uint64_t{256} << 20;  // [byte]

bool has_word(std::string_view name, std::initializer_list<std::string_view> words) {
  while (!name.empty()) {
    auto end = std::min(name.find('_'), name.size());
    if (std::find(words.begin(), words.end(), name.substr(0, end)) != words.end()) return true;
    name.remove_prefix(std::min(end + 1, name.size()));
  }
  return false;
}

bool looks_like_path(std::string_view value) {
  if (value.find('/') == std::string_view::npos) return false;
  if (value.find_first_of("!%*?\n") != std::string_view::npos) return false;
  return value.find(':') >= value.find('/');  // else a URI, as http://robot/stream
}

std::string folder_of(std::string_view path) {
  auto folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

void add_end(const std::string& module, const std::string& text, bool is_input, Needs& needs) {
  auto uri = hc::parse_uri(text);
  if (!uri) return;
  if (uri->scheme == "tcp-listen") {
    needs.ports.push_back({module, text, uri->rest});
  } else if (uri->scheme == "file") {
    needs.paths.push_back(
        {module, "link " + text, is_input ? uri->rest : folder_of(uri->rest), !is_input});
  } else if (uri->scheme == "unix-listen" && !uri->rest.starts_with('@')) {
    needs.paths.push_back({module, "link " + text, folder_of(uri->rest), true});
  }
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string gigabytes(std::uint64_t bytes) {
  return hc::format("{:.1f} GB", static_cast<double>(bytes) / 1e9);
}

void add_devices(std::vector<Finding>& findings, const std::string& what,
                 const std::vector<Device>& devices, std::string_view none) {
  std::vector<std::string> open, closed;
  for (const auto& device : devices) (device.opens ? open : closed).push_back(device.path);
  if (!open.empty()) findings.push_back({Mark::Ok, what, joined(open)});
  if (!closed.empty())
    findings.push_back({Mark::Note, what, joined(closed) + ": may not be opened by this user"});
  if (devices.empty()) findings.push_back({Mark::Note, what, std::string(none)});
}

void add_limits(std::vector<Finding>& findings, const Facts& facts) {
  constexpr auto kAny = std::numeric_limits<std::uint64_t>::max();
  auto in_words = [](std::uint64_t limit) {
    return limit == kAny ? std::string("any number of") : hc::format("{}", limit);
  };
  bool is_low = facts.descriptors < kFewDescriptors || facts.processes < kFewProcesses;
  findings.push_back(
      {is_low ? Mark::Note : Mark::Ok, "limits",
       hc::format("{} descriptors a process, {} processes a user{}", in_words(facts.descriptors),
                  in_words(facts.processes), is_low ? ": few for a large graph (ulimit)" : "")});
}

Finding finding_of(const NeededPath& needed, const PathState& state) {
  auto marked = [&](Mark mark, std::string_view text) {
    return Finding{mark, needed.module, hc::format("{}: {}{}", needed.what, needed.path, text)};
  };
  if (!state.is_there) return marked(Mark::Missing, " does not exist");
  if (needed.is_written && !state.is_folder) return marked(Mark::Missing, " is not a folder");
  if (needed.is_written && !state.is_writable)
    return marked(Mark::Missing, " is not writable for this user");
  if (!needed.is_written && !state.is_readable)
    return marked(Mark::Missing, " is not readable for this user");
  return marked(Mark::Ok, "");
}

std::string_view name(Mark mark) {
  switch (mark) {
    case Mark::Ok:
      return "ok";
    case Mark::Missing:
      return "missing";
    case Mark::Wrong:
      return "wrong";
    case Mark::Note:
      break;
  }
  return "note";
}

}  // namespace

bool path_of_parameter(std::string_view name, std::string_view value, NeededPath& path) {
  if (!looks_like_path(value)) return false;
  const bool is_device = value.starts_with("/dev/");
  const bool is_written = !is_device && has_word(name, {"save", "output", "log", "record"});
  const bool is_read = is_device || has_word(name, {"source", "file", "path", "folder", "directory",
                                                    "device", "model", "config"});
  if (!is_written && !is_read) return false;
  path.what = "parameter " + std::string(name);
  path.path = is_written ? folder_of(value) : std::string(value);
  path.is_written = is_written;
  return true;
}

Needs needs_of(const hc::Plan& plan) {
  Needs needs;
  needs.modules = plan.modules.size();
  for (const auto& module : plan.modules) {
    const auto& given = module.parameters;
    if (std::filesystem::path(module.program).filename() == "view" && !given.contains("save"))
      needs.viewers.push_back(module.name);
    for (const auto& [name, value] : given) {
      NeededPath path{module.name, "", "", false};
      if (path_of_parameter(name, value, path)) needs.paths.push_back(path);
    }
    for (const auto& end : module.ends) add_end(module.name, end.uri, end.is_input, needs);
  }
  return needs;
}

std::vector<Finding> diagnose(const Facts& facts) {
  std::vector<Finding> findings;
  std::vector<std::string> there;
  for (const auto& feature : facts.kernel)
    if (feature.error.empty()) there.push_back(feature.name);
  findings.push_back(
      {Mark::Ok, "kernel", facts.release + (there.empty() ? "" : ": " + joined(there))});
  for (const auto& feature : facts.kernel)
    if (!feature.error.empty())
      findings.push_back({Mark::Missing, "kernel", feature.name + ": " + feature.error});
  add_limits(findings, facts);
  findings.push_back({Mark::Ok, "processors", hc::format("{}", facts.processors)});
  findings.push_back({facts.free_memory < kLittleMemory ? Mark::Note : Mark::Ok, "memory",
                      gigabytes(facts.memory) + ", " + gigabytes(facts.free_memory) + " free"});
  add_devices(findings, "camera", facts.cameras, "none (/dev/video*)");
  add_devices(findings, "sound", facts.sounds, "none (/dev/snd)");
  if (!facts.sound_cards.empty())
    findings.push_back({Mark::Ok, "sound", joined(facts.sound_cards)});
  add_devices(findings, "serial", facts.serials, "none (/dev/ttyUSB*, ttyACM*, ttyS*)");
  add_devices(findings, "joystick", facts.joysticks, "none (/dev/input/js*, event*)");
  add_devices(findings, "graphics", facts.renderers, "none (/dev/dri)");
  findings.push_back(
      facts.display.empty()
          ? Finding{Mark::Note, "display", "none: view can only save images; or use xvfb-run"}
          : Finding{Mark::Ok, "display", facts.display});
  findings.push_back(facts.has_graphviz ? Finding{Mark::Ok, "graphviz", "dot"}
                                        : Finding{Mark::Note, "graphviz",
                                                  "dot is not installed; hc graph --svg needs it"});
  findings.push_back(facts.modules.empty() ? Finding{Mark::Missing, "modules", "none beside hc"}
                                           : Finding{Mark::Ok, "modules", joined(facts.modules)});
  if (!facts.broken_modules.empty())
    findings.push_back(
        {Mark::Missing, "modules", joined(facts.broken_modules) + ": may not be executed"});
  return findings;
}

std::vector<Finding> diagnose(const Needs& needs, const Facts& facts) {
  std::vector<Finding> findings;
  for (const auto& needed : needs.paths) {
    auto known = facts.paths.find(needed.path);
    findings.push_back(
        finding_of(needed, known == facts.paths.end() ? PathState{} : known->second));
  }
  for (const auto& needed : needs.ports) {
    auto known = facts.ports.find(needed.port);
    const std::string error = known == facts.ports.end() ? "" : known->second;
    findings.push_back({error.empty() ? Mark::Ok : Mark::Missing, needed.module,
                        "link " + needed.uri + (error.empty() ? "" : ": " + error)});
  }
  for (const auto& viewer : needs.viewers)
    if (facts.display.empty())
      findings.push_back({Mark::Missing, viewer, "a display; its parameter save does without one"});
  if (needs.modules > facts.processors)
    findings.push_back({Mark::Note, "processors",
                        hc::format("{} for {} modules", facts.processors, needs.modules)});
  return findings;
}

bool is_ill(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.mark == Mark::Missing || finding.mark == Mark::Wrong;
  });
}

std::string as_text(const std::vector<Finding>& findings) {
  std::size_t widest = 0;
  for (const auto& finding : findings) widest = std::max(widest, finding.what.size());
  std::string text;
  for (const auto& finding : findings)
    text +=
        hc::format("{:<7}  {:<{}}  {}\n", name(finding.mark), finding.what, widest, finding.text);
  return text;
}

}  // namespace tool
