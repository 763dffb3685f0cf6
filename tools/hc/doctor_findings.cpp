// SPDX-License-Identifier: Apache-2.0
#include "doctor_findings.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <initializer_list>
#include <limits>

#include <hc/base/format.h>
#include <hc/base/uri.h>

#include "common.h"

namespace tool {
namespace {

constexpr std::uint64_t kFewDescriptors = 1024;
constexpr std::uint64_t kFewProcesses = 256;
constexpr std::uint64_t kLittleMemory = std::uint64_t{256} << 20;  // [byte]

bool has_word(std::string_view name, std::initializer_list<std::string_view> words) {
  const auto all = "_" + std::string(name) + "_";
  return std::ranges::any_of(words, [&](std::string_view word) {
    return all.find("_" + std::string(word) + "_") != std::string::npos;
  });
}

/// Whether a name ends like that of a file: a dot, a letter, and one to four letters and digits.
bool has_extension(std::string_view name) {
  auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  auto is_either = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
  const auto ending = std::string_view(name).substr(std::min(name.rfind('.'), name.size() - 1) + 1);
  return ending.size() >= 2 && ending.size() <= 5 && ending.size() + 1 < name.size() &&
         is_letter(ending.front()) && std::ranges::all_of(ending, is_either);
}

bool looks_like_path(std::string_view value) {
  if (value.find_first_of("!%*?\n") != std::string_view::npos) return false;
  const auto slash = value.find('/'), colon = value.find(':');
  if (slash == std::string_view::npos) return colon == slash && has_extension(value);
  return colon >= slash;  // otherwise a URI, such as http://robot/stream
}

std::string folder_of(std::string_view path) {
  auto folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

Need need_of_path(const std::string& module, const std::string& what, const std::string& path,
                  bool is_written) {
  const auto place = is_written ? folder_of(path) : path;
  return {module, what + ": " + place, (is_written ? "write " : "read ") + place};
}

void add_end(const std::string& module, const std::string& text, bool is_input, Needs& needs) {
  const auto uri = hc::parse_uri(text);
  if (!uri) return;
  const auto link = "link " + text;
  if (uri->scheme == "tcp-listen")
    needs.places.push_back({module, link, "listen " + uri->rest});
  else if (uri->scheme == "file" || (uri->scheme == "unix-listen" && !uri->rest.starts_with('@')))
    needs.places.push_back(
        need_of_path(module, link, uri->rest, !is_input || uri->scheme != "file"));
}

/// Whether a parameter names a file or folder to write, though its name reads like one to read.
bool is_result(const hc::PlannedModule& module, std::string_view parameter) {
  const auto program = std::filesystem::path(module.program).filename();
  return (program == "stereo_calibration" && parameter == "calibration_file") ||
         (program == "recorder" && (parameter == "file" || parameter == "folder"));
}

std::string gigabytes(std::uint64_t bytes) {
  return hc::format("{:.1f} GB", static_cast<double>(bytes) / 1e9);
}

void add_devices(std::vector<Finding>& findings, const Devices& devices) {
  const auto& [kind, where, open, closed] = devices;
  if (!open.empty()) findings.push_back({Mark::Ok, kind, joined(open)});
  if (!closed.empty())
    findings.push_back({Mark::Note, kind, joined(closed) + ": no permission for this user"});
  if (open.empty() && closed.empty())
    findings.push_back({Mark::Note, kind, "none (" + where + ")"});
}

void add_limits(std::vector<Finding>& findings, const Facts& facts) {
  constexpr auto kAny = std::numeric_limits<std::uint64_t>::max();
  auto in_words = [](std::uint64_t limit) {
    return limit == kAny ? std::string("any number of") : hc::format("{}", limit);
  };
  bool is_low = facts.descriptors < kFewDescriptors || facts.processes < kFewProcesses;
  findings.push_back({is_low ? Mark::Note : Mark::Ok, "limits",
                      hc::format("{} descriptors per process, {} processes per user{}",
                                 in_words(facts.descriptors), in_words(facts.processes),
                                 is_low ? ": low for a large graph (ulimit)" : "")});
}

constexpr std::string_view kMarks[] = {"ok", "missing", "wrong", "note"};  // in the order of Mark

}  // namespace

std::optional<Need> need_of_parameter(const std::string& module, std::string_view name,
                                      std::string_view value) {
  if (!looks_like_path(value)) return std::nullopt;
  const bool is_device = value.starts_with("/dev/");
  const bool is_written = !is_device && has_word(name, {"save", "output", "log", "record"});
  const bool is_read = is_device || has_word(name, {"source", "file", "path", "folder", "directory",
                                                    "device", "model", "config"});
  if (!is_written && !is_read) return std::nullopt;
  return need_of_path(module, "parameter " + std::string(name), std::string(value), is_written);
}

std::vector<std::string> Needs::questions() const {
  std::vector<std::string> questions;
  for (const auto& place : places) questions.push_back(place.question);
  return questions;
}

Needs needs_of(const hc::Plan& plan) {
  Needs needs;
  needs.modules = plan.modules.size();
  for (const auto& module : plan.modules) {
    const auto& given = module.parameters;
    const auto window = given.find("window");
    const bool may_have_none =
        given.contains("save") || (window != given.end() && window->second == "no");
    if (std::filesystem::path(module.program).filename() == "view" && !may_have_none)
      needs.viewers.push_back(module.name);
    for (const auto& [name, value] : given)
      if (auto need = need_of_parameter(module.name, name, value); need && !is_result(module, name))
        needs.places.push_back(std::move(*need));
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
  for (const auto& devices : facts.devices) add_devices(findings, devices);
  if (!facts.sound_cards.empty())
    findings.push_back({Mark::Ok, "sound", joined(facts.sound_cards)});
  findings.push_back(
      facts.display.empty()
          ? Finding{Mark::Note, "display", "none: view can only save images; or use xvfb-run"}
          : Finding{Mark::Ok, "display", facts.display});
  findings.push_back(facts.has_graphviz ? Finding{Mark::Ok, "graphviz", "dot"}
                                        : Finding{Mark::Note, "graphviz",
                                                  "dot is not installed; hc graph --svg needs it"});
  findings.push_back(
      facts.networks.empty()
          ? Finding{Mark::Note, "networks",
                    "no weights in " + facts.networks_folder +
                        ": the Debian package hypercolumn has them, and ./dev build unpacks them"}
          : Finding{Mark::Ok, "networks", joined(facts.networks)});
  findings.push_back(facts.modules.empty()
                         ? Finding{Mark::Missing, "modules", "none installed with hc"}
                         : Finding{Mark::Ok, "modules", joined(facts.modules)});
  if (!facts.broken_modules.empty())
    findings.push_back(
        {Mark::Missing, "modules", joined(facts.broken_modules) + ": not executable"});
  return findings;
}

std::vector<Finding> diagnose(const Needs& needs, const Facts& facts) {
  std::vector<Finding> findings;
  for (const auto& place : needs.places) {
    const auto known = facts.problems.find(place.question);
    const auto problem = known == facts.problems.end() ? ": not checked" : known->second;
    findings.push_back(
        {problem.empty() ? Mark::Ok : Mark::Missing, place.module, place.text + problem});
  }
  for (const auto& viewer : needs.viewers)
    if (facts.display.empty())
      findings.push_back({Mark::Missing, viewer, "a display; set its parameter save instead"});
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
    text += hc::format("{:<7}  {:<{}}  {}\n", kMarks[static_cast<std::size_t>(finding.mark)],
                       finding.what, widest, finding.text);
  return text;
}

}  // namespace tool
