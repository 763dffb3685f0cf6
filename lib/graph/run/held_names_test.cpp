// SPDX-License-Identifier: Apache-2.0
#include <graph/run/held_names.h>

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <vector>

#include <graph/plan.h>
#include <graph/process.h>
#include <hc/base/uri.h>
#include <hc/link/link.h>
#include <hc/link/stream/ends.h>
#include <hc/os/wait_readable.h>
#include <hc/testing/must.h>

namespace hc::internal {
namespace {

std::string name(const std::string& end) {
  return "held-" + std::to_string(::getpid()) + "-" + end;
}

std::vector<std::string> writer() {
  return {"camera",
          "--control",
          "unix:@c",
          "--out",
          "left=shm:" + name("left") + "?readers=2&stay=1",
          "--out",
          "right=unix-listen:@" + name("right") + "?readers=1",
          "--out",
          "right=unix-listen:/tmp/" + name("file"),
          "--in",
          "size=shm:" + name("in")};
}

bool is_free(const std::string& uri) {
  return open_sink(*parse_uri(uri)).has_value();
}
std::string left() {
  return "shm:" + name("left");
}
std::string right() {
  return "unix-listen:@" + name("right");
}

TEST(HeldNames, are_free_for_nobody_else_until_they_are_let_go) {
  HeldNames names;
  ASSERT_TRUE(names.hold(writer()));
  EXPECT_EQ(names.descriptors().size(), 2U);
  const auto before = names.descriptors();
  ASSERT_TRUE(names.hold(writer()));  // for its next process
  EXPECT_EQ(names.descriptors(), before);
  EXPECT_FALSE(is_free(left()));
  EXPECT_FALSE(is_free(right()));
  EXPECT_TRUE(is_free("shm:" + name("in")));
  ASSERT_TRUE(names.hold({"camera", "--control", "unix:@c", "--out", "left=" + left()}));
  EXPECT_TRUE(is_free(right()));
  names.release();
  EXPECT_TRUE(is_free(left()));
}

TEST(HeldNames, none_has_the_number_of_a_key) {
  ::close(kKeyDescriptor);  // in case the test has inherited it
  HeldNames names;
  ASSERT_TRUE(names.hold(writer()));
  for (const int number : names.descriptors()) EXPECT_GT(number, kKeyDescriptor);
}

TEST(HeldNames, who_is_given_them_listens_there) {
  HeldNames names;
  ASSERT_TRUE(names.hold(writer()));
  std::string numbers;
  for (const int number : names.descriptors()) numbers += std::to_string(number) + " ";
  ::setenv(kListeners, ("99 0 " + numbers).c_str(), 1);
  for (int i = 0; i < 2; ++i) {
    EXPECT_TRUE(is_free(left()));
    EXPECT_TRUE(is_free(right()));
  }
  ::unsetenv(kListeners);
  EXPECT_FALSE(is_free(left()));
}

TEST(HeldNames, are_given_to_a_process) {
  HeldNames names;
  ASSERT_TRUE(names.hold(writer()));
  auto process = Process::start(
      {"/bin/sh", "-c", "for n in $HC_LISTENERS; do readlink /proc/self/fd/$n; done"},
      Process::Capture::Output, {-1, names.descriptors()});
  ASSERT_TRUE(process);
  std::string said;
  for (char letter = 0;; said += letter) {
    std::vector<int> output = {process->output()};
    EXPECT_TRUE(wait_readable(output));
    if (::read(output[0], &letter, 1) <= 0) break;
  }
  EXPECT_EQ(said.find("socket:"), 0U) << said;
  EXPECT_NE(said.rfind("socket:"), 0U) << said;
}

TEST(HeldNames, none_of_a_module_that_does_not_know_of_them) {
  HeldNames names;
  ASSERT_TRUE(names.hold({"java", "--out", "left=" + right()}));
  EXPECT_TRUE(names.descriptors().empty());
  EXPECT_TRUE(is_free(right()));
}

TEST(HeldNames, one_that_another_has_is_an_error) {
  auto other = must(open_sink(*parse_uri(left())));
  HeldNames names;
  EXPECT_EQ(refused(names.hold(writer())).code, Code::System);
}

}  // namespace
}  // namespace hc::internal
