// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/graph_state.h>

#include <gtest/gtest.h>

namespace hc {
namespace {

GraphState some_state() {
  GraphState state;
  state.name = "head";
  state.file = "graphs/head.toml";
  state.process = 12;
  state.uptime = 3.25;
  state.focus = {{"left", 1}, {"right", 0}};
  state.stopped = {{"right", {"web.stop", "source 14"}}};
  state.modes = {{"read", 2}, {"track", 1}};
  state.addresses = {{"eyes.command", 21}};
  ModuleState module;
  module.name = "camera";
  module.program = "camera";
  module.host = "robot";
  module.workspace = "left";
  module.status = ModuleStatus::GivenUp;
  module.detail = "failed with status 1";
  module.exit = 1;
  module.last_line = "no device";
  module.last_line_age = 2;
  module.parameters = {{"source", "a \"b\"\n"}};
  state.modules = {module};
  HostState host;
  host.name = "robot";
  host.is_connected = true;
  host.offset = 3600.5;
  host.error = 0.25;
  host.latency = 0.5;
  state.hosts = {host};
  LinkState link;
  link.from = "camera.left";
  link.to = "view.image";
  link.transport = "shm";
  link.keep = "latest";
  link.rate = 5;
  link.traffic.messages = 7;
  link.traffic.dropped_newer = 3;
  link.traffic.throttled = 4;
  link.age = {0.5, 1, 2};
  state.links = {link};
  return state;
}

TEST(State, IsOneLineOfJson) {
  EXPECT_EQ(
      to_json(some_state()),
      R"({"graph":"head","file":"graphs/head.toml","pid":12,"uptime":3.25,)"
      R"("modes":{"read":2,"track":1},"addresses":{"eyes.command":21},)"
      R"("stopped":["right"],"stopped_by":{"right":["web.stop","source 14"]},"status":"running","focus":{"left":{"mode":"track","number":1},"right":null},)"
      R"("hosts":[{"name":"robot","connected":true,"detail":"","offset":3600.5,"error":0.25,)"
      R"("drift":null,"latency":0.5}],)"
      R"("modules":[{"name":"camera","program":"camera","host":"robot","group":"",)"
      R"("pid":0,"status":"given up","detail":"failed with status 1","restarts":0,"exit":1,)"
      R"("cpu":0.0,"memory":0,"mode":"","modes":[],"workspace":"left","in_focus":true,"in_workspace":false,)"
      R"("waits_for":"","waits":null,"last_line":"no device","last_level":"info",)"
      R"("last_line_age":2.0,)"
      R"("parameters":{"source":"a \"b\"\n"}}],"links":[{"from":"camera.left",)"
      R"("to":"view.image","transport":"shm","status":"","keep":"latest","rate":5.0,"bandwidth":0.0,"images":null,"messages":7,"bytes":0,)"
      R"("per_second":0.0,"bytes_per_second":0.0,"delayed":0,"throttled":4,"dropped_newer":3,)"
      R"("dropped_memory":0,"dropped_disconnect":0,"dropped_timeout":0,"ignored":0,"bad":0,"age":[0.5,1.0,2.0],"gap":null,)"
      R"("in_workspace":false}]})");
}

TEST(State, IsReadAsItWasWritten) {
  const auto json = to_json(some_state());
  auto state = parse_graph_state(json);
  ASSERT_TRUE(state);
  EXPECT_EQ(to_json(*state), json);
  EXPECT_EQ(state->modules.at(0).status, ModuleStatus::GivenUp);
  EXPECT_EQ(state->links.at(0).age->at(2), 2);
}

TEST(State, OfAnOlderGraphNamesNoSourcesOfStops) {
  const auto state = parse_graph_state(
      R"({"status":"running","focus":{"w":null},"stopped":["w"],"modules":[],"links":[]})");
  ASSERT_TRUE(state);
  EXPECT_EQ(state->stopped_in_words(), "stopped");
}

TEST(State, AnythingElseIsMalformed) {
  for (const char* text :
       {"", "7", "{}", "[1]", R"({"graph":7})",
        R"({"status":"running","focus":{},"modules":[1],"links":[]})",
        R"({"status":"running","focus":{},"modules":[{"cpu":""}],"links":[]})",
        R"({"status":"running","focus":{"w":7},"modules":[],"links":[]})",
        R"({"status":"running","focus":[1],"modules":[],"links":[]})",
        R"({"status":"running","focus":{},"stopped":[1],"modules":[],"links":[]})"}) {
    auto state = parse_graph_state(text);
    ASSERT_FALSE(state) << text;
    EXPECT_EQ(state.error().code, Code::Malformed);
  }
}

TEST(State, AFocusWithoutANameIsItsNumber) {
  GraphState state;
  state.focus = {{"workspace", 7}};
  state.modes = {{"read", 2}};
  EXPECT_NE(to_json(state).find(R"({"mode":"7","number":7})"), std::string::npos);
  EXPECT_EQ(state.focus_in_words(), "7");
  EXPECT_EQ(state.stopped_in_words(), "");
  state.stopped = {{"workspace", {"web.stop"}}};
  EXPECT_EQ(state.stopped_in_words(), "stopped by web.stop");
}

TEST(State, TheFocusOfTwoWorkspacesIsShownForEach) {
  auto state = some_state();
  EXPECT_EQ(state.focus_in_words(), "left: track, right: none");
  EXPECT_EQ(state.stopped_in_words(), "stopped: right by web.stop, source 14");
  state.stopped["left"] = {"hands.stop"};
  EXPECT_EQ(state.stopped_in_words(), "stopped: left by hands.stop; right by web.stop, source 14");
  EXPECT_EQ(state.focus_of(state.modules.at(0)), "track");
  state.modules[0].workspace = "right";
  EXPECT_EQ(state.focus_of(state.modules.at(0)), "");
  state.focus = {{"left", 0}, {"right", 0}};
  EXPECT_EQ(state.focus_in_words(), "");
}

TEST(State, WhatIsNoUtf8IsReplaced) {
  GraphState state;
  state.file = "\xff";
  EXPECT_NE(to_json(state).find("\"file\":\"\xef\xbf\xbd\""), std::string::npos);
}

}  // namespace
}  // namespace hc
