// SPDX-License-Identifier: Apache-2.0
#include "doctor_findings.h"

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
  facts.devices = {{"camera", "/dev/video*"}};
  facts.modules = {"camera", "view"};
  facts.networks_folder = "/usr/share/hypercolumn/nets";
  facts.networks = {"hand_landmark_lite"};
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
  facts.devices = {{"camera", "/dev/video*", {"/dev/video0"}, {"/dev/video1"}}};
  auto findings = diagnose(facts);
  EXPECT_EQ(find(findings, "camera", Mark::Ok)->text, "/dev/video0");
  EXPECT_EQ(find(findings, "camera", Mark::Note)->text, "/dev/video1: no permission for this user");
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
  EXPECT_EQ(find(diagnose(facts), "modules", Mark::Missing)->text, "depth: not executable");
  facts.broken_modules.clear();
  facts.modules.clear();
  EXPECT_TRUE(is_ill(diagnose(facts)));
}

TEST(Doctor, WeightsThatAreMissingComeWithThePackage) {
  auto facts = good_facts();
  EXPECT_EQ(find(diagnose(facts), "networks", Mark::Ok)->text, "hand_landmark_lite");
  facts.networks.clear();
  const auto findings = diagnose(facts);
  EXPECT_EQ(
      find(findings, "networks", Mark::Note)->text,
      "no weights in /usr/share/hypercolumn/nets: the Debian package hypercolumn has them, and "
      "./dev build unpacks them");
  EXPECT_FALSE(is_ill(findings));
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
    const char *name, *value, *question;  // empty: no path
  };
  const Case cases[] = {
      {"source", "/data/a.jpg", "read /data/a.jpg"},
      {"right_source", "./a.jpg", "read ./a.jpg"},
      {"model_file", "models/face.onnx", "read models/face.onnx"},
      {"port", "/dev/ttyUSB0", "read /dev/ttyUSB0"},
      {"source", "a.jpg", "read a.jpg"},
      {"model", "face.v2.onnx", "read face.v2.onnx"},
      {"save", "/out/depth.png", "write /out"},
      {"save", "depth.png", "write ."},
      {"save", "pictures/", "write pictures"},
      {"log_file", "logs/a.txt", "write logs"},
      // Ambiguous values are not checked.
      {"source", "0", ""},
      {"source", "camera", ""},
      {"source", "1.5", ""},
      {"source", "a.b", ""},
      {"source", ".jpg", ""},
      {"source", "a.", ""},
      {"source", "aravis:Basler-1.jpg", ""},
      {"source", "http://robot/stream", ""},
      {"source", "videotestsrc ! video/x-raw ! appsink", ""},
      {"source", "/data/left_%03d.png", ""},
      {"topic", "head/eyes", ""},
      {"profile", "/a/b", ""},
      {"unit", "m/s", ""},
      {"path", "", ""},
  };
  for (const auto& each : cases) {
    const auto need = need_of_parameter("", each.name, each.value);
    EXPECT_EQ(need ? need->question : "", each.question) << each.value;
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
  EXPECT_EQ(needs.questions(), (std::vector<std::string>{"read /none.jpg", "listen 7000",
                                                         "read /focus.mtp", "write logs"}));
}

TEST(Doctor, ResultsNeedNoFile) {
  hc::Plan plan;
  plan.modules.resize(2);
  plan.modules[0].program = "/lib/recorder";
  plan.modules[0].parameters = {
      {"file", "run.mcap"}, {"folder", "out/kept"}, {"frames_file", "f.txt"}};
  plan.modules[1].program = "/lib/stereo_calibration";
  plan.modules[1].parameters = {{"calibration_file", "head.yml"}};
  EXPECT_EQ(needs_of(plan).questions(), std::vector<std::string>{"read f.txt"});
}

TEST(Doctor, AViewWithoutAWindowNeedsNoDisplay) {
  for (const auto& [name, value] : {std::pair("window", "no"), {"save", "a.png"}}) {
    auto plan = some_plan();
    plan.modules.back().parameters[name] = value;
    EXPECT_TRUE(needs_of(plan).viewers.empty()) << name;
  }
}

TEST(Doctor, WhatARunWouldMiss) {
  auto needs = needs_of(some_plan());
  auto facts = good_facts();
  facts.processors = 1;
  facts.problems = {{"read /none.jpg", " does not exist"},
                    {"read /focus.mtp", " is not readable for this user"},
                    {"write logs", " is not writable for this user"},
                    {"listen 7000", ": tcp-listen:7000: Address already in use"}};
  EXPECT_EQ(as_text(diagnose(needs, facts)),
            "missing  eye         parameter source: /none.jpg does not exist\n"
            "missing  eye         link tcp-listen:7000?readers=1: tcp-listen:7000: Address already"
            " in use\n"
            "missing  eye         link file:/focus.mtp: /focus.mtp is not readable for this user\n"
            "missing  eye         link logs/eye.mtp: logs is not writable for this user\n"
            "missing  window      a display; set its parameter save instead\n"
            "note     processors  1 for 2 modules\n");
}

TEST(Doctor, AGraphThatMissesNothing) {
  auto needs = needs_of(some_plan());
  auto facts = good_facts();
  facts.display = "DISPLAY=:0";
  for (const auto& question : needs.questions()) facts.problems[question] = "";
  auto findings = diagnose(needs, facts);
  EXPECT_FALSE(is_ill(findings));
  EXPECT_EQ(findings.size(), 4U);
}

}  // namespace
}  // namespace tool
