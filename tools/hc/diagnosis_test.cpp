// SPDX-License-Identifier: Apache-2.0
#include "diagnosis.h"

#include <gtest/gtest.h>

namespace tool {
namespace {

Facts good_facts() {
  Facts facts;
  facts.kernel = {{"pidfd", ""}, {"futex", ""}};
  facts.release = "Linux 6.1";
  facts.descriptors = 1 << 20;
  facts.processes = 30000;
  facts.processors = 4;
  facts.memory = 16'000'000'000;
  facts.free_memory = 8'000'000'000;
  facts.modules = {"camera", "view"};
  return facts;
}

const Finding* find(const std::vector<Finding>& findings, std::string_view what, Mark mark) {
  for (const auto& finding : findings)
    if (finding.what == what && finding.mark == mark) return &finding;
  return nullptr;
}

TEST(Doctor, DevicesThatAreNotThereAreNotesAndNoIllness) {
  auto findings = diagnose(good_facts());
  EXPECT_FALSE(is_ill(findings));
  ASSERT_NE(find(findings, "camera", Mark::Note), nullptr);
  EXPECT_EQ(find(findings, "kernel", Mark::Ok)->text, "Linux 6.1: pidfd, futex");
  EXPECT_EQ(find(findings, "memory", Mark::Ok)->text, "16.0 GB, 8.0 GB free");
}

TEST(Doctor, DevicesThatMayNotBeOpenedAreReported) {
  auto facts = good_facts();
  facts.cameras = {{"/dev/video0", true}, {"/dev/video1", false}};
  auto findings = diagnose(facts);
  EXPECT_EQ(find(findings, "camera", Mark::Ok)->text, "/dev/video0");
  EXPECT_EQ(find(findings, "camera", Mark::Note)->text,
            "/dev/video1: may not be opened by this user");
  EXPECT_FALSE(is_ill(findings));
}

TEST(Doctor, AKernelWithoutWhatLinksNeedIsIllness) {
  auto facts = good_facts();
  facts.kernel.push_back({"membarrier", "Function not implemented"});
  auto findings = diagnose(facts);
  EXPECT_TRUE(is_ill(findings));
  EXPECT_EQ(find(findings, "kernel", Mark::Missing)->text, "membarrier: Function not implemented");
  EXPECT_EQ(find(findings, "kernel", Mark::Ok)->text, "Linux 6.1: pidfd, futex");
}

TEST(Doctor, ModulesAreNeeded) {
  auto facts = good_facts();
  facts.broken_modules = {"depth"};
  EXPECT_EQ(find(diagnose(facts), "modules", Mark::Missing)->text, "depth: may not be executed");
  facts.broken_modules.clear();
  facts.modules.clear();
  EXPECT_TRUE(is_ill(diagnose(facts)));
}

TEST(Doctor, LowLimitsAreNotes) {
  auto facts = good_facts();
  facts.descriptors = 100;
  auto findings = diagnose(facts);
  EXPECT_NE(find(findings, "limits", Mark::Note), nullptr);
  EXPECT_FALSE(is_ill(findings));
}

TEST(Doctor, ParametersThatNamePaths) {
  struct Case {
    const char *name, *value, *path;  // path: null where none is named
    bool is_written;
  };
  const Case cases[] = {
      {"source", "/data/a.jpg", "/data/a.jpg", false},
      {"right_source", "./a.jpg", "./a.jpg", false},
      {"model_file", "models/face.onnx", "models/face.onnx", false},
      {"port", "/dev/ttyUSB0", "/dev/ttyUSB0", false},
      {"save", "/out/depth.png", "/out", true},
      {"save", "pictures/", "pictures", true},
      {"log_file", "logs/a.txt", "logs", true},
      // What could be anything is left alone.
      {"source", "0", nullptr, false},
      {"source", "a.jpg", nullptr, false},
      {"source", "http://robot/stream", nullptr, false},
      {"source", "videotestsrc ! video/x-raw ! appsink", nullptr, false},
      {"source", "/data/left_%03d.png", nullptr, false},
      {"topic", "head/eyes", nullptr, false},
      {"profile", "/a/b", nullptr, false},
      {"unit", "m/s", nullptr, false},
      {"path", "", nullptr, false},
  };
  for (const auto& each : cases) {
    NeededPath path;
    EXPECT_EQ(path_of_parameter(each.name, each.value, path), each.path != nullptr) << each.value;
    if (each.path == nullptr) continue;
    EXPECT_EQ(path.path, each.path);
    EXPECT_EQ(path.is_written, each.is_written) << each.value;
  }
}

hc::Plan some_plan() {
  hc::Plan plan;
  hc::PlannedModule camera;
  camera.name = "eye";
  camera.program = "/lib/camera";
  camera.parameters = {{"source", "/none.jpg"}, {"width", "80"}};
  camera.ends = {{false, "left", "shm:x.eye.left?readers=1", ""},
                 {false, "left", "tcp-listen:7000?readers=1", ""},
                 {true, "focus", "file:/focus.mtp", ""},
                 {false, "right", "logs/eye.mtp", ""},
                 {false, "right", "unix-listen:@abstract", ""}};
  plan.modules.push_back(camera);
  hc::PlannedModule view;
  view.name = "window";
  view.program = "/lib/view";
  plan.modules.push_back(view);
  return plan;
}

TEST(Doctor, WhatAPlanNamesOutsideOfItself) {
  auto needs = needs_of(some_plan());
  EXPECT_EQ(needs.modules, 2U);
  EXPECT_EQ(needs.viewers, std::vector<std::string>{"window"});
  ASSERT_EQ(needs.paths.size(), 3U);
  EXPECT_EQ(needs.paths[0].path, "/none.jpg");
  EXPECT_EQ(needs.paths[1].path, "/focus.mtp");
  EXPECT_EQ(needs.paths[2].path, "logs");
  EXPECT_TRUE(needs.paths[2].is_written);
  ASSERT_EQ(needs.ports.size(), 1U);
  EXPECT_EQ(needs.ports[0].port, "7000");
}

TEST(Doctor, WhatARunWouldMiss) {
  auto needs = needs_of(some_plan());
  auto facts = good_facts();
  facts.processors = 1;
  facts.paths["/focus.mtp"] = {.is_there = true};
  facts.paths["logs"] = {.is_there = true, .is_readable = true, .is_folder = true};
  facts.ports["7000"] = "tcp-listen:7000: Address already in use";
  EXPECT_EQ(as_text(diagnose(needs, facts)),
            "missing  eye         parameter source: /none.jpg does not exist\n"
            "missing  eye         link file:/focus.mtp: /focus.mtp is not readable for this user\n"
            "missing  eye         link logs/eye.mtp: logs is not writable for this user\n"
            "missing  eye         link tcp-listen:7000?readers=1: tcp-listen:7000: Address already"
            " in use\n"
            "missing  window      a display; its parameter save does without one\n"
            "note     processors  1 for 2 modules\n");
}

TEST(Doctor, AGraphThatMissesNothing) {
  auto needs = needs_of(some_plan());
  auto facts = good_facts();
  facts.display = "DISPLAY=:0";
  facts.paths["/none.jpg"] = {.is_there = true, .is_readable = true};
  facts.paths["/focus.mtp"] = facts.paths["/none.jpg"];
  facts.paths["logs"] = {
      .is_there = true, .is_readable = true, .is_folder = true, .is_writable = true};
  auto findings = diagnose(needs, facts);
  EXPECT_FALSE(is_ill(findings));
  EXPECT_EQ(findings.size(), 4U);
}

}  // namespace
}  // namespace tool
