// SPDX-License-Identifier: Apache-2.0
#include <nets/weights.h>

#include <gtest/gtest.h>

namespace {

using hc::nets::read_weights;
using hc::nets::weights_path;

TEST(Weights, are_found_from_where_the_program_is) {
  const auto notice = read_weights(weights_path("NOTICE"));
  ASSERT_TRUE(notice) << notice.error().text();
  EXPECT_NE(notice->find("public domain"), std::string::npos);
}

TEST(Weights, that_are_missing_come_with_the_package) {
  const auto path = weights_path("none.tflite");
  const auto missing = read_weights(path);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().text(),
            "NotFound: " + path +
                ": cannot be read: No such file or directory; the Debian package hypercolumn has "
                "it, and ./dev build unpacks it");
}

TEST(Weights, other_files_that_cannot_be_read_are_named) {
  const auto missing = read_weights("/nowhere/a.tflite");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().text(),
            "NotFound: /nowhere/a.tflite: cannot be read: No such file or directory");
  const auto folder = read_weights("/tmp");
  ASSERT_FALSE(folder);
  EXPECT_EQ(folder.error().code, hc::Code::System);
}

}  // namespace
