// SPDX-License-Identifier: Apache-2.0
#pragma once
// Shared by the tests of plans: descriptions of programs that do not exist.

#include <map>
#include <string>
#include <vector>

#include <graph/plan.h>
#include <hc/testing/must.h>

namespace hc {

inline const std::string kVersionLine = "version = 1\n";

/// Descriptions of the programs in tests.
inline Result<std::string> describe(const std::string& program, const std::string& = "") {
  auto port = [](const std::string& name, const std::string& type, int coord) {
    return R"({"name":")" + name + R"(","types":[{"type":")" + type +
           R"(","components":1,"scalar":"f32","width":0,"height":0,"coord":)" +
           std::to_string(coord) + "}]}";
  };
  auto module = [](const std::string& inputs, const std::string& outputs) {
    return R"({"name":"x","inputs":[)" + inputs + R"(],"outputs":[)" + outputs +
           R"(],"parameters":[{"name":"rate","type":"number","min":0,"max":9},)"
           R"({"name":"mode","type":"string","choices":["fast","good"]}]})";
  };
  if (program == "source")
    return module("", port("left", "map", 7) + "," + port("right", "map", 8));
  if (program == "filter") return module(port("in", "map", 0), port("out", "map", 0));
  if (program == "sink") return module(port("in", "map", 8) + "," + port("text", "string", 0), "");
  if (program == "pair") {
    std::string text = module(port("left", "map", 0) + "," + port("right", "map", 0), "");
    return text.replace(text.size() - 1, 1, R"(,"together":[["left","right"]]})");
  }
  if (program == "keeper")  // inputs that keep only some messages
    return module(R"({"name":"in","types":[],"keep":1},{"name":"some","types":[],"keep":16})",
                  port("out", "map", 0));
  if (program == "any") return module(R"({"name":"in","types":[]})", "");
  const std::string transports = R"(,"transports":["-","unix","unix-listen","shm"]})";
  auto shares = [&](std::string text) { return text.replace(text.size() - 1, 1, transports); };
  if (program == "eye") return shares(module("", port("image", "intensity_image", 0)));
  auto lists = [](std::string text, const std::string& schemes) {
    return text.replace(text.size() - 1, 1, ",\"transports\":[" + schemes + "]}");
  };
  if (program == "java")
    return lists(module(port("in", "map", 0), port("out", "map", 0)), R"("tcp","tcp-listen")");
  if (program == "far")
    return lists(module(port("in", "map", 0), port("out", "map", 0)),
                 R"("dds","shm","tcp","tcp-listen","tls","tls-listen","unix","unix-listen")");
  if (program == "camera")
    return lists(R"({"name":"x","inputs":[],"outputs":[{"name":"image","types":[{"type":)"
                 R"("rgb_image","components":3,"scalar":"u8","width":0,"height":0,"coord":7}]}],)"
                 R"("parameters":[],"control":true})",
                 R"("shm","tls","tls-listen","unix")");
  if (program == "fixed")
    return lists(
        R"({"name":"x","inputs":[{"name":"in","types":[{"type":"rgb_image","components":)"
        R"(3,"scalar":"u8","width":640,"height":480,"coord":0}]},{"name":"any","types":[]}],)"
        R"("outputs":[],"parameters":[]})",
        R"("shm","tls","tls-listen")");
  if (program == "files") return lists(module(port("in", "map", 0), ""), R"("file","tcp-listen")");
  if (program == "liar") return lists(module("", ""), R"("tcp"],"control":true,"together":[)");
  if (program == "seer")
    return shares(
        module(port("in", "intensity_image", 0) + "," + port("more", "intensity_image", 0), ""));
  auto controlled = [](std::string text, const std::string& more = "") {
    return text.replace(text.size() - 1, 1, R"(,"control":true)" + more + "}");
  };
  const std::string anything = R"({"name":"in","types":[]})";
  if (program == "router")
    return controlled(module(anything, R"({"name":"out","types":[]},)" + port("counts", "map", 0)),
                      R"(,"routes":true)");
  if (program == "task")
    return controlled(
        module(port("image", "map", 0), port("command", "map", 0) + "," + port("bid", "map", 0)));
  if (program == "actor") {
    std::string input = port("command", "map", 0);
    input.replace(input.size() - 1, 1, R"(,"actor":true})");
    return controlled(module(input, port("pose", "map", 0)));
  }
  if (program == "workspace") {
    std::string text = controlled(
        module(port("bids", "map", 0),
               R"({"name":"focus","types":[{"type":"table","components":1,"scalar":"i32",)"
               R"("width":1,"height":1,"coord":0}]})"));
    return text.replace(text.find("\"parameters\":["), 14,
                        R"("parameters":[{"name":"mode_names","type":"string"},)"
                        R"({"name":"source_names","type":"string"},)");
  }
  if (program == "titled")
    return std::string(R"({"name":"x","inputs":[],"outputs":[],"parameters":[)"
                       R"({"name":"mode_names","type":"string"}]})");
  if (program == "counted")
    return std::string(R"({"name":"x","inputs":[],"outputs":[],"parameters":[)"
                       R"({"name":"mode_names","type":"integer"}]})");
  if (program == "framed")
    return std::string(R"({"name":"x","inputs":[],"outputs":[],"parameters":[)"
                       R"({"name":"frames","type":"string"},)"
                       R"({"name":"file","type":"string","fixed":true}]})");
  const std::string pose =
      R"("types":[{"type":"transformation","components":1,"scalar":"f64","width":4,"height":4,)"
      R"("coord":0}]})";
  if (program == "posed")
    return module(
        "", port("left", "map", 7) + "," + port("right", "map", 8) + R"(,{"name":"pose",)" + pose);
  if (program == "neck")
    return shares(module(port("command", "map", 0), R"({"name":"pose",)" + pose));
  if (program == "seeker")  // takes frames and moves one
    return shares(R"({"name":"x","inputs":[{"name":"frames",)" + pose + R"(],"outputs":[)" +
                  port("command", "map", 0) + R"(,{"name":"pose",)" + pose +
                  R"(],"parameters":[{"name":"frames","type":"string","fixed":true}]})");
  if (program == "loud") return module("", port("Out", "map", 0));
  if (program == "dumb") return std::string("hello");
  if (program == "odd") return std::string(R"({"inputs":[{}],"outputs":3,"parameters":[{"x":1}]})");
  return Error{Code::NotFound, "no such program"};
}

/// Plans a graph. Errors: all problems, a line each.
///
/// @param text  of the graph file, without its first line `version = 1`.
/// @param files  that it may include, without that line too.
inline Result<Plan> plan(const std::string& text,
                         const std::map<std::string, std::string>& files = {},
                         const Plan* before = nullptr, const HoldPort& hold_port = {},
                         const HostPlaces& places = {}) {
  Problems problems("g.toml");
  auto read_file = [&](const std::string& name) -> Result<std::string> {
    auto found = files.find(name);
    if (found != files.end()) return kVersionLine + found->second;
    return Error{Code::NotFound, name + ": cannot be read"};
  };
  auto graph = parse_graph(
      kVersionLine + text, [](const char*) -> const char* { return nullptr; }, problems, read_file);
  Plan plan = make_plan(graph, describe, "t", problems, before, hold_port, places);
  if (problems.empty()) return plan;
  std::string all;
  for (const auto& line : problems.lines()) all += (all.empty() ? "" : "\n") + line;
  return Error{Code::Invalid, all};
}

inline std::string text_of(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

/// The values of an option in a module's command.
inline std::vector<std::string> values_of(const PlannedModule& module, const std::string& option) {
  std::vector<std::string> values;
  const auto command = module.command();
  for (std::size_t i = 0; i + 1 < command.size(); ++i)
    if (command[i] == option) values.push_back(command[i + 1]);
  return values;
}

/// The links of a plan with their `keep`, a line each; or all problems.
inline std::string links_of(const Result<Plan>& planned) {
  if (!planned) return planned.error().detail;
  std::string text;
  for (const auto& link : planned->links)
    text += link.from + " " + link.to + " " + link.keep + "\n";
  return text;
}

/// The problems of a graph, a line each; empty: none.
inline std::string wrong(const std::string& text,
                         const std::map<std::string, std::string>& files = {}) {
  auto planned = plan(text, files);
  return planned ? "" : planned.error().detail;
}

/// A link of a graph file.
inline std::string link_text(const std::string& from, const std::string& to,
                             const std::string& more = "") {
  auto end = [](const std::string& port, const std::string& kind) {
    const auto dot = port.find('.');
    return "[[modules." + port.substr(0, dot) + "." + kind + "." + port.substr(dot + 1) + "]]\n";
  };
  if (to.find(':') == std::string::npos)
    return end(to, "inputs") + "from = \"" + from + "\"\n" + more;
  return end(from, "outputs") + "to = \"" + to + "\"\n" + more;
}

}  // namespace hc
