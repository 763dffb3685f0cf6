// SPDX-License-Identifier: Apache-2.0
#include <drivers/joystick/device_file.h>

#include <unistd.h>

#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

namespace {

TEST(DeviceFile, one_alone_has_it_until_it_lets_go) {
  std::string path = "/tmp/device_file_XXXXXX";
  const int made = ::mkstemp(path.data());
  ASSERT_GE(made, 0);
  ::close(made);
  {
    const auto first = hc::DeviceFile::open(path);
    EXPECT_TRUE(first.file);
    EXPECT_FALSE(first.is_taken);
    EXPECT_TRUE(hc::DeviceFile::open(path).is_taken);
  }
  EXPECT_FALSE(hc::DeviceFile::open(path).is_taken);
  ::unlink(path.c_str());
}

TEST(DeviceFile, one_that_cannot_be_opened_is_nobodys) {
  const auto none = hc::DeviceFile::open("/nosuch/device");
  EXPECT_FALSE(none.file);
  EXPECT_FALSE(none.is_taken);
}

}  // namespace
