// SPDX-License-Identifier: Apache-2.0
#include <hc/adapter/eigen.h>

#include <gtest/gtest.h>

namespace hc {
namespace {

TEST(Eigen, SharesATransformation) {
  Draft draft = Draft::make({MatrixType::Transformation, 1, Scalar::F64, Encoding::Text}, 4, 3);
  auto made = as_eigen<double>(draft);
  ASSERT_EQ(made.rows(), 3);
  ASSERT_EQ(made.cols(), 4);
  made.setZero();
  made(2, 3) = 5;
  Message message = std::move(draft).finish();
  auto seen = as_eigen<double>(message);
  ASSERT_TRUE(seen);
  EXPECT_EQ(static_cast<const void*>(seen->data()), message.elements.data());
  EXPECT_EQ((*seen)(2, 3), 5);
  EXPECT_EQ(message.view<double>()->at(2, 3), 5);
  EXPECT_FALSE(as_eigen<float>(message));
}

TEST(Eigen, APathHasARowForEachPosition) {
  Draft draft = Draft::make(Info(), 1, 5);
  EXPECT_EQ(as_eigen<double>(draft).rows(), 5);
  EXPECT_EQ(as_eigen<double>(draft).cols(), 3);
}

}  // namespace
}  // namespace hc
