// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/trace.h>

#include <gtest/gtest.h>

#include <hc/mtp/rows.h>

namespace hc {
namespace {

using What = TraceEvent::What;

TEST(Trace, IsReadAsItWasWritten) {
  const std::vector<TraceEvent> events = {
      {What::Took, "image", 3, 7, unix_time(1000), unix_time(2000)},
      {What::Began, "", 0, 0, Time(), unix_time(2001), 2},
      {What::Ended, "", 0, 0, Time(), unix_time(2002)},
      {What::Sent, "target", 4, 8, Time::max(), Time::max()},
      {What::Lost, "", 0, 12, Time(), unix_time(2004)},
      {What::Set, "modes", 0, 0, Time(), unix_time(2005), 0, "read=5, track=4"},
      {What::Set, "file", 0, 0, Time(), unix_time(2006), 0, ""},
      {What::Read, "", 0, 0, Time(), unix_time(2007)},
      {What::Unlinked, "out", 0, 9, Time(), unix_time(2008), 0, "shm:a?readers=1"},
      {What::Linked, "out", 0, 10, Time(), unix_time(2009), 0, "shm:a?as=jpeg&quality=5"}};
  const Message message = make_trace(events);
  EXPECT_EQ(rows_of(message)[0], "took image 3 7 1000 2000");
  EXPECT_EQ(rows_of(message)[1], "began - 0 0 0 2001 2");
  EXPECT_EQ(rows_of(message)[5], "set modes 2005 read=5, track=4");
  EXPECT_EQ(rows_of(message)[9], "linked out 10 2009 shm:a?as=jpeg&quality=5");
  EXPECT_EQ(read_trace(message), events);
}

TEST(Trace, MalformedRowsAreIgnored) {
  const std::vector<std::string> rows = {"took image 3 7 1000",
                                         "took image 3 7 1000 2000 1 2",
                                         "took image 3 7 1000 2000 x",
                                         "jumped image 3 7 1000 2000",
                                         "took image 3 7.5 1000 2000",
                                         "took image 3000000000 7 1 2",
                                         "took image 3 7 -1 2000",
                                         "took image 3 7 1000 -9223372036854775808",
                                         "set rate x 5",
                                         "set rate -5 5",
                                         "linked out 2009 shm:a",
                                         "sent a 1 2 3 4",
                                         ""};
  EXPECT_EQ(read_trace(make_rows(rows)),
            (std::vector<TraceEvent>{{What::Sent, "a", 1, 2, unix_time(3), unix_time(4)}}));
}

}  // namespace
}  // namespace hc
