// SPDX-License-Identifier: Apache-2.0
#pragma once
// Runs a test with each vector instruction set of this processor.

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#define HWY_WANT_AVX3_DL
#include <hwy/highway.h>

namespace hc {

class TestOfVectors : public testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { hwy::SetSupportedTargetsForTest(GetParam()); }
  void TearDown() override { hwy::SetSupportedTargetsForTest(0); }
};

inline auto each_kind_of_vectors() {
  constexpr std::int64_t kVectors =
      HWY_SSSE3 | HWY_SSE4 | HWY_AVX2 | HWY_AVX3 | HWY_AVX3_DL | HWY_NEON;
  std::vector<std::int64_t> found;
  // Highway reports no NEON on an ARM without AES instructions, but uses it nevertheless.
  for (std::int64_t left = (hwy::SupportedTargets() | HWY_STATIC_TARGET) & kVectors; left != 0;
       left &= left - 1)
    found.push_back(left & -left);
  return testing::ValuesIn(found);
}

inline std::string name_of_vectors(const testing::TestParamInfo<std::int64_t>& each) {
  return hwy::TargetName(each.param);
}

}  // namespace hc
