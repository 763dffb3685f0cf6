// SPDX-License-Identifier: Apache-2.0
#include "drawing.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

#include <hc/base/format.h>
#include <hc/base/json_string.h>

#include "common.h"
#include "screen.h"

namespace tool {
namespace {

constexpr const char *kWorking = "#e8f4e8", *kIdle = "#eeeeee", *kTrouble = "#ffc8c8";

/// MODULE and PORT, or a URI and "".
std::pair<std::string, std::string> split(const std::string& end) {
  auto dot = end.find('.');
  bool is_outside = end.find(':') != std::string::npos || dot == std::string::npos;
  if (is_outside) return {end, ""};
  return {end.substr(0, dot), end.substr(dot + 1)};
}

std::string in_quotes(const std::string& text) {
  std::string result;
  hc::append_json_string(text, result);
  return result;
}

/// Escapes text for Graphviz's HTML-like labels.
std::string in_html(const std::string& text) {
  std::string result;
  for (char c : text)
    result += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return result;
}

/// A module as a table: name, words, and rows of an input and an output.
std::string table_of(const Drawing::Box& box, const std::vector<std::string>& inputs,
                     const std::vector<std::string>& outputs) {
  const char* color = box.is_wrong ? kTrouble : box.is_idle ? kIdle : kWorking;
  std::string text = hc::format(
      "<TABLE BORDER=\"{}\" CELLBORDER=\"0\" CELLSPACING=\"0\" CELLPADDING=\"4\" STYLE=\"ROUNDED\" "
      "BGCOLOR=\"{}\"><TR><TD COLSPAN=\"2\"><B>{}</B></TD></TR>",
      box.is_bold ? 4 : 1, color, in_html(box.name));
  if (!box.words.empty())
    text += hc::format(R"(<TR><TD COLSPAN="2"><FONT POINT-SIZE="10">{}</FONT></TD></TR>)",
                       in_html(box.words));
  for (std::size_t i = 0; i < std::max(inputs.size(), outputs.size()); ++i) {
    text += "<TR>";
    for (const auto& [ports, kind, side] :
         {std::tuple(&inputs, "in_", "LEFT"), {&outputs, "out_", "RIGHT"}})
      text += i < ports->size() ? hc::format(
                                      "<TD PORT=\"{}{}\" ALIGN=\"{}\"><FONT POINT-SIZE=\"11\">"
                                      "{}</FONT></TD>",
                                      kind, in_html((*ports)[i]), side, in_html((*ports)[i]))
                                : "<TD></TD>";
    text += "</TR>";
  }
  return text + "</TABLE>";
}

constexpr const char* kLegend =
    R"(  legend [shape=plain, label=<<TABLE BORDER="0" CELLBORDER="1" CELLSPACING="4">
    <TR><TD BGCOLOR="#e8f4e8">working</TD><TD BGCOLOR="#eeeeee">idle: not in focus, or ended</TD>
    <TD BGCOLOR="#ffc8c8">in trouble</TD><TD BORDER="4">in the global workspace</TD></TR></TABLE>>];
)";

}  // namespace

Drawing drawing_of(const hc::Plan& plan, const std::string& title) {
  Drawing drawing;
  drawing.title = title;
  for (const auto& module : plan.modules) {
    std::vector<std::string> words = {std::filesystem::path(module.program).filename()};
    if (words.front() == module.name) words.clear();
    if (!module.mode.empty()) words.push_back("mode: " + module.mode);
    drawing.boxes.push_back({module.name, joined(words), module.group});
  }
  for (const auto& link : plan.links) {
    std::vector<std::string> words;
    if (link.keep != "all") words.push_back("keep " + link.keep);
    for (const auto& [key, value] : link.policy) words.push_back(key + " " + value);
    drawing.arrows.push_back({link.from, link.to, joined(words)});
  }
  return drawing;
}

Drawing drawing_of(const hc::GraphState& state) {
  Drawing drawing;
  drawing.title = state.name;
  drawing.is_running = true;
  if (const auto focus = state.focus_in_words(); !focus.empty())
    drawing.title += ", focus: " + focus;
  for (const auto& module : state.modules) {
    Drawing::Box box;
    box.name = module.name;
    box.group = module.group;
    box.is_bold = module.in_workspace;
    box.is_wrong = is_in_trouble(module);
    box.is_idle = !module.in_focus || module.status == hc::ModuleStatus::Ended;
    box.words = module.status == hc::ModuleStatus::Running && module.detail.empty()
                    ? hc::format("{:.1f} %", 100 * module.processor)
                    : status_text(module);
    drawing.boxes.push_back(std::move(box));
  }
  for (const auto& link : state.links) {
    auto words = short_number(link.per_second) + "/s";
    if (link.keep != "all") words += ", keep " + link.keep;
    if (link.rate > 0) words += hc::format(", rate {}", link.rate);
    drawing.arrows.push_back({link.from, link.to, words, link.in_workspace, !link.status.empty()});
  }
  return drawing;
}

std::string as_text(const Drawing& drawing, bool is_plain) {
  auto bold = [&](const std::string& text, bool is_bold) {
    return is_bold && !is_plain ? hc::format("{}{}{}", kBold, text, kNormal) : text;
  };
  std::string text = drawing.title + "\n";
  for (const auto& box : drawing.boxes) {
    text += "\n" + bold(box.name, box.is_bold);
    if (!box.words.empty()) text += "  (" + box.words + ")";
    text += '\n';
    for (const auto& arrow : drawing.arrows) {
      auto [module, port] = split(arrow.from);
      if (module != box.name) continue;
      auto line = hc::format("  {} → {}", port, arrow.to);
      text += bold(line, arrow.is_bold) + (arrow.words.empty() ? "" : "  " + arrow.words) + "\n";
    }
  }
  std::string outside;
  for (const auto& arrow : drawing.arrows)
    if (split(arrow.from).second.empty())
      outside += hc::format("  {} → {}  {}\n", arrow.from, arrow.to, arrow.words);
  return text + (outside.empty() ? "" : "\noutside\n" + outside);
}

std::string as_dot(const Drawing& drawing) {
  std::map<std::string, std::vector<std::string>> inputs, outputs;  // by module
  std::set<std::string> outside;
  auto add = [](std::vector<std::string>& ports, const std::string& port) {
    if (std::find(ports.begin(), ports.end(), port) == ports.end()) ports.push_back(port);
  };
  for (const auto& arrow : drawing.arrows) {
    for (const auto& [end, ports] : {std::pair(&arrow.from, &outputs), {&arrow.to, &inputs}}) {
      auto [module, port] = split(*end);
      if (port.empty())
        outside.insert(module);
      else
        add((*ports)[module], port);
    }
  }
  std::string text = hc::format(
      "digraph {{\n  label={};\n  labelloc=t;\n  fontsize=18;\n  rankdir=LR;\n  nodesep=0.35;\n"
      "  ranksep=1.2;\n  fontname=\"sans-serif\";\n"
      "  node [shape=plain, fontname=\"sans-serif\"];\n"
      "  edge [fontname=\"sans-serif\", fontsize=10, color=\"#555555\", fontcolor=\"#333333\"];\n",
      in_quotes(drawing.title));
  std::map<std::string, std::string> groups;  // boxes, by group
  for (const auto& box : drawing.boxes)
    groups[box.group] += hc::format("  {} [label=<{}>];\n", in_quotes(box.name),
                                    table_of(box, inputs[box.name], outputs[box.name]));
  for (const auto& [group, boxes] : groups)
    text += group.empty() ? boxes
                          : hc::format(
                                "  subgraph {} {{\n  label={};\n  color=\"#999999\";\n"
                                "  style=\"rounded,dashed\";\n{}  }}\n",
                                in_quotes("cluster_" + group), in_quotes(group), boxes);
  for (const auto& name : outside) text += hc::format("  {};\n", in_quotes(name));
  for (const auto& arrow : drawing.arrows) {
    auto [from, output] = split(arrow.from);
    auto [to, input] = split(arrow.to);
    text += in_quotes(from) + (output.empty() ? "" : ":" + in_quotes("out_" + output) + ":e") +
            " -> " + in_quotes(to) + (input.empty() ? "" : ":" + in_quotes("in_" + input) + ":w") +
            hc::format(" [label={}", in_quotes(arrow.words));
    if (arrow.is_bold) text += ", penwidth=3, color=black";
    if (arrow.is_wrong) text += R"(, color="#cc0000", fontcolor="#cc0000")";
    text += "];\n";
  }
  if (drawing.is_running) text += kLegend;
  return text + "}\n";
}

}  // namespace tool
