// SPDX-License-Identifier: Apache-2.0
#include "drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "screen.h"

namespace tool {
namespace {

constexpr std::string_view kBold = "\x1b[1m", kNormal = "\x1b[0m";

/// MODULE and PORT; a URI stands for itself.
std::pair<std::string, std::string> split(const std::string& end) {
  auto dot = end.find('.');
  bool is_outside = end.find(':') != std::string::npos || dot == std::string::npos;
  if (is_outside) return {end, ""};
  return {end.substr(0, dot), end.substr(dot + 1)};
}

std::string in_quotes(const std::string& text) {
  std::string result = "\"";
  for (char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

}  // namespace

Drawing drawing_of(const hc::Plan& plan, const std::string& title) {
  Drawing drawing;
  drawing.title = title;
  for (const auto& module : plan.modules) {
    auto program = std::filesystem::path(module.program).filename().string();
    drawing.boxes.push_back({module.name, program == module.name ? "" : program});
    if (!module.mode.empty()) drawing.boxes.back().words += " mode " + module.mode;
  }
  for (const auto& link : plan.links) {
    std::string words = link.keep == "all" ? "" : "keep " + link.keep;
    for (const auto& [key, value] : link.policy)
      words.append(words.empty() ? "" : ", ").append(key).append(" ").append(value);
    drawing.arrows.push_back({link.from, link.to, words});
  }
  return drawing;
}

Drawing drawing_of(const nlohmann::json& state) {
  Drawing drawing;
  drawing.title = state.at("graph");
  if (const auto& focus = state.at("focus"); !focus.is_null())
    drawing.title += ", focus: " + focus.at("mode").get<std::string>();
  for (const auto& module : state.at("modules")) {
    Drawing::Box box;
    box.name = module.at("name");
    const std::string status = module.at("status"), detail = module.at("detail");
    box.is_bold = module.at("in_workspace");
    box.is_wrong = status != "running" && status != "starting" && status != "ended";
    box.is_idle = !module.at("in_focus").get<bool>() || status == "ended";
    box.words = status != "running" ? status
                : detail.empty()    ? fmt::format("{:.1f} %", 100 * module.at("cpu").get<double>())
                                    : detail;
    drawing.boxes.push_back(std::move(box));
  }
  for (const auto& link : state.at("links")) {
    auto words = short_number(link.at("per_second").get<double>()) + "/s";
    if (const std::string keep = link.at("keep"); keep != "all") words += ", keep " + keep;
    if (auto rate = link.at("rate").get<double>(); rate > 0)
      words += fmt::format(", rate {}", rate);
    drawing.arrows.push_back(
        {link.at("from"), link.at("to"), words, link.at("in_workspace").get<bool>()});
  }
  return drawing;
}

std::string as_text(const Drawing& drawing, bool is_plain) {
  auto bold = [&](const std::string& text, bool is_bold) {
    return is_bold && !is_plain ? fmt::format("{}{}{}", kBold, text, kNormal) : text;
  };
  std::string text = drawing.title + "\n";
  for (const auto& box : drawing.boxes) {
    text += "\n" + bold(box.name, box.is_bold);
    if (!box.words.empty()) text += "  (" + box.words + ")";
    text += '\n';
    for (const auto& arrow : drawing.arrows) {
      auto [module, port] = split(arrow.from);
      if (module != box.name) continue;
      auto line = fmt::format("  {} → {}", port, arrow.to);
      text += bold(line, arrow.is_bold) + (arrow.words.empty() ? "" : "  " + arrow.words) + "\n";
    }
  }
  std::string outside;
  for (const auto& arrow : drawing.arrows)
    if (split(arrow.from).second.empty())
      outside += fmt::format("  {} → {}  {}\n", arrow.from, arrow.to, arrow.words);
  return text + (outside.empty() ? "" : "\noutside\n" + outside);
}

std::string as_dot(const Drawing& drawing) {
  std::string text = fmt::format(
      "digraph {{\n  label={};\n  labelloc=t;\n  rankdir=LR;\n  fontname=\"sans-serif\";\n"
      "  node [shape=box, style=\"rounded,filled\", fillcolor=white, fontname=\"sans-serif\"];\n"
      "  edge [fontname=\"sans-serif\", fontsize=10, color=\"#555555\"];\n",
      in_quotes(drawing.title));
  for (const auto& box : drawing.boxes) {
    auto label = box.name + (box.words.empty() ? "" : "\n" + box.words);
    text += fmt::format("  {} [label={}", in_quotes(box.name), in_quotes(label));
    if (box.is_bold) text += ", penwidth=3";
    if (box.is_wrong) text += ", fillcolor=\"#ffd0d0\"";
    if (box.is_idle) text += ", fontcolor=\"#808080\", color=\"#808080\"";
    text += "];\n";
  }
  std::map<std::string, bool> outside;
  for (const auto& arrow : drawing.arrows) {
    auto [from, output] = split(arrow.from);
    auto [to, input] = split(arrow.to);
    for (const auto& [name, port] : {std::pair(from, output), std::pair(to, input)})
      if (port.empty() && !std::exchange(outside[name], true))
        text += fmt::format("  {} [shape=plain];\n", in_quotes(name));
    text += fmt::format("  {} -> {} [taillabel={}, headlabel={}, label={}", in_quotes(from),
                        in_quotes(to), in_quotes(output), in_quotes(input), in_quotes(arrow.words));
    if (arrow.is_bold) text += ", penwidth=3, color=black";
    text += "];\n";
  }
  return text + "}\n";
}

}  // namespace tool
