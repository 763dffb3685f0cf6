// SPDX-License-Identifier: Apache-2.0
#include <hc/graph/state.h>

#include <gtest/gtest.h>

namespace hc {
namespace {

TEST(State, IsOneLineOfJson) {
  GraphState state;
  state.name = "head";
  state.file = "graphs/head.toml";
  state.process = 12;
  state.uptime = 3.25;
  state.focus = 1;
  state.modes = {{"read", 2}, {"track", 1}};
  state.addresses = {{"eyes.command", 21}};
  ModuleState module;
  module.name = "camera";
  module.program = "camera";
  module.status = ModuleStatus::GivenUp;
  module.detail = "failed with status 1";
  module.exit = 1;
  module.parameters = {{"source", "a \"b\"\n"}};
  state.modules = {module};
  LinkState link;
  link.from = "camera.left";
  link.to = "view.image";
  link.transport = "shm";
  link.keep = "latest";
  link.rate = "5";
  link.traffic.messages = 7;
  link.traffic.superseded = 3;
  link.age = {0.5, 1, 2};
  state.links = {link};
  EXPECT_EQ(
      to_json(state),
      R"({"graph":"head","file":"graphs/head.toml","pid":12,"uptime":3.25,"status":"running",)"
      R"("focus":{"mode":"track","number":1},"modules":[{"name":"camera","program":"camera",)"
      R"("pid":0,"status":"given up","detail":"failed with status 1","restarts":0,"exit":1,)"
      R"("cpu":0.0,"memory":0,"mode":"","modes":[],"in_focus":true,"in_workspace":false,)"
      R"("parameters":{"source":"a \"b\"\n"}}],"links":[{"from":"camera.left",)"
      R"("to":"view.image","transport":"shm","keep":"latest","rate":5.0,"messages":7,"bytes":0,)"
      R"("per_second":0.0,"bytes_per_second":0.0,"kept_back":0,"lost":{"superseded":3},)"
      R"("left_out":0,"age":[0.5,1.0,2.0],"gap":null,"in_workspace":false}],)"
      R"("modes":{"read":2,"track":1},"addresses":{"eyes.command":21}})");
}

TEST(State, AFocusWithoutANameIsItsNumber) {
  GraphState state;
  state.focus = 7;
  state.modes = {{"read", 2}};
  EXPECT_NE(to_json(state).find(R"("focus":{"mode":"7","number":7})"), std::string::npos);
  state.focus = 0;
  EXPECT_EQ(state.focus_name(), "");
}

TEST(State, WhatIsNoUtf8IsReplaced) {
  GraphState state;
  state.file = "\xff";
  EXPECT_NE(to_json(state).find("\"file\":\"\xef\xbf\xbd\""), std::string::npos);
}

}  // namespace
}  // namespace hc
