// SPDX-License-Identifier: Apache-2.0
#include "npy.h"

#include <gtest/gtest.h>

#include <string>

namespace tool {
namespace {

std::string npy(const std::string& dictionary, const std::string& data) {
  std::string text = std::string("\x93NUMPY\x01\x00", 8);
  text += static_cast<char>(dictionary.size());
  text += '\0';
  return text + dictionary + data;
}

hc::Result<hc::Message> read(const std::string& bytes) {
  return read_npy(std::as_bytes(std::span(bytes)));
}

TEST(Npy, ArraysBecomeMatrices) {
  auto image =
      read(npy("{'descr': '|u1', 'fortran_order': False, 'shape': (1, 2, 3), }\n", "abcdef"));
  ASSERT_TRUE(image) << image.error().detail;
  EXPECT_EQ(image->header.info.type, hc::MatrixType::RgbImage);
  EXPECT_EQ(image->header.width, 2);
  EXPECT_EQ(image->text(), "abcdef");
  auto row = read(npy("{'descr': '<i2', 'fortran_order': False, 'shape': (3,), }\n", "aabbcc"));
  ASSERT_TRUE(row);
  EXPECT_EQ(row->header.info.type, hc::MatrixType::Table);
  EXPECT_EQ(row->header.width, 3);
  EXPECT_EQ(row->header.height, 1);
  auto number = read(npy("{'descr': '<f8', 'fortran_order': False, 'shape': (), }\n", "12345678"));
  ASSERT_TRUE(number);
  EXPECT_EQ(number->header.width, 1);
}

TEST(Npy, RefusesWhatIsNoMatrix) {
  for (const std::string& bytes :
       {std::string(), std::string("\x93NUMPY\x01\x00\xff\xff__", 12),
        npy("{'descr': '>f8', 'fortran_order': False, 'shape': (1,), }", "12345678"),
        npy("{'descr': '<c8', 'fortran_order': False, 'shape': (1,), }", "12345678"),
        npy("{'descr': '<f8', 'fortran_order': True, 'shape': (1,), }", "12345678"),
        npy("{'descr': '<f8', 'fortran_order': False, 'shape': (1,2,3,4), }", ""),
        npy("{'descr': '<f8', 'fortran_order': False, 'shape': (99999999,99999999), }", ""),
        npy("{'descr': '<f8', 'fortran_order': False, 'shape': (-1,), }", ""),
        npy("{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }", "12345678"),
        npy("{'descr': '<f8', 'fortran_order': False, 'shape': (1,1,200), }", ""), npy("{}", "")})
    EXPECT_FALSE(read(bytes)) << bytes;
}

}  // namespace
}  // namespace tool
