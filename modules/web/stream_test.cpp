// SPDX-License-Identifier: Apache-2.0
#include "stream.h"

#include <gtest/gtest.h>

namespace {

TEST(Wanted, is_read_from_options) {
  const auto wanted = parse_wanted("as=jpeg&width=400&rate=2.5");
  ASSERT_TRUE(wanted);
  EXPECT_EQ(wanted->form, Form::Jpeg);
  EXPECT_EQ(wanted->width, 400);
  EXPECT_EQ(wanted->rate, 2.5);
  const auto changed = parse_wanted("width=0", *wanted);
  EXPECT_EQ(changed->width, 0);
  EXPECT_EQ(changed->form, Form::Jpeg);
  EXPECT_EQ(parse_wanted("")->form, Form::Raw);
}

TEST(Wanted, anything_else_is_refused) {
  for (const char* text : {"as=png", "width", "width=-1", "width=1e3", "width=65501", "rate=nan",
                           "rate=-1", "size=3", "=", "as"})
    EXPECT_FALSE(parse_wanted(text)) << text;
}

}  // namespace
