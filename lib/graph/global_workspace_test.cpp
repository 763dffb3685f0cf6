// SPDX-License-Identifier: Apache-2.0
#include <graph/global_workspace.h>

#include <gtest/gtest.h>

namespace hc {
namespace {

using Names = std::set<std::string>;

/// A robot with two tasks: one follows moving objects with its head, the other reads text.
Plan robot() {
  Plan plan;
  auto add = [&](const std::string& name, const std::string& mode = "",
                 std::vector<std::string> modes = {}) {
    PlannedModule& module = plan.modules.emplace_back();
    module.name = name;
    module.mode = mode;
    module.modes = std::move(modes);
    module.workspace = "workspace";
  };
  add("camera");
  add("motion", "", {"track"});
  add("text", "", {"read"});
  add("track", "track");
  add("read", "read");
  add("head");
  add("view");
  add("workspace");
  plan.modules[5].exclusive = {"command"};
  plan.workspaces = {"workspace"};
  auto link = [&](const std::string& from, const std::string& to) {
    PlannedLink& planned = plan.links.emplace_back();
    planned.from = from;
    planned.to = to;
  };
  link("camera.left", "motion.image");      // 0
  link("camera.left", "text.image");        // 1
  link("camera.left", "view.image");        // 2
  link("motion.target", "track.target");    // 3
  link("text.words", "read.words");         // 4
  link("track.command", "head.command");    // 5
  link("read.command", "head.command");     // 6
  link("head.pose", "track.pose");          // 7
  link("head.pose", "view.pose");           // 8
  link("track.bid", "workspace.bids");      // 9
  link("workspace.focus", "head.focus");    // 10
  link("workspace.focus", "motion.focus");  // 11
  link("tcp-listen:7000", "head.trim");     // 12
  return plan;
}

void expect_workspace(const Plan& plan, const std::string& mode, const Names& modules,
                      const std::set<std::size_t>& links) {
  auto workspace = global_workspace(plan, {{"workspace", mode}});
  EXPECT_EQ(workspace.modules, modules) << mode;
  EXPECT_EQ(workspace.links, links) << mode;
}

TEST(GlobalWorkspace, IsWhatLeadsThroughTheTaskToTheActorAndFollowsTheFocus) {
  expect_workspace(robot(), "track", {"camera", "motion", "track", "head"}, {0, 3, 5, 7});
  expect_workspace(robot(), "read", {"camera", "text", "read", "head"}, {1, 4, 6});
}

TEST(GlobalWorkspace, IsEmptyWithoutATaskThatActs) {
  expect_workspace(robot(), "", {}, {});
  expect_workspace(robot(), "sleep", {}, {});
  Plan plan = robot();
  plan.modules[5].exclusive.clear();  // no exclusive input
  expect_workspace(plan, "track", {}, {});
}

TEST(GlobalWorkspace, GoesThroughRouters) {
  Plan plan = robot();
  plan.modules.emplace_back().name = "router";
  plan.links[5].to = plan.links[6].to = "router.in";
  PlannedLink& link = plan.links.emplace_back();
  link.from = "router.out";
  link.to = "head.command";
  expect_workspace(plan, "track", {"camera", "motion", "track", "router", "head"},
                   {0, 3, 5, 7, 13});
}

TEST(GlobalWorkspace, TheTasksOfTwoWorkspacesWithModesOfTheSameNamesAreApart) {
  Plan plan = robot();
  const Plan other = robot();
  for (auto module : other.modules) {
    module.name = "b_" + module.name;
    module.workspace = "b_workspace";
    plan.modules.push_back(std::move(module));
  }
  for (auto link : other.links) {
    link.from = "b_" + link.from;
    link.to = "b_" + link.to;
    plan.links.push_back(std::move(link));
  }
  plan.workspaces.insert("b_workspace");
  auto workspace = global_workspace(plan, {{"workspace", "track"}, {"b_workspace", "read"}});
  EXPECT_EQ(workspace.modules,
            (Names{"camera", "motion", "track", "head", "b_camera", "b_text", "b_read", "b_head"}));
  EXPECT_EQ(workspace.links, (std::set<std::size_t>{0, 3, 5, 7, 14, 17, 19}));
}

}  // namespace
}  // namespace hc
