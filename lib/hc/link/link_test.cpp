// SPDX-License-Identifier: Apache-2.0
#include <hc/link/link.h>

#include <algorithm>

#include <gtest/gtest.h>

#include <hc/link/stream/ends.h>
#include <hc/link/transports.h>
#include <hc/os/wait_readable.h>

namespace hc {
namespace {

TEST(Open, ASchemeThatThereIsNotIsRefusedByName) {
  auto source = open_source(*parse_uri("pigeon:home"));
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, Code::Invalid);
  EXPECT_EQ(source.error().detail,
            "no transport \"pigeon\"; available: -, file, tcp, tcp-listen, unix, unix-listen, "
            "inproc, shm");
  EXPECT_FALSE(open_sink(*parse_uri("pigeon:home")));
}

TEST(Open, WhatAProgramDoesNotAddItDoesNotHave) {
  for (const char* uri : {"tls:h:1?key=a&peer=b", "tls-listen:1?key=a&peer=b", "dds:topic"})
    EXPECT_TRUE(open_source(*parse_uri(uri))
                    .error()
                    .detail.ends_with(
                        "; tls and dds need OpenSSL and Cyclone DDS when a program is built, and "
                        "hc::add_all_transports() in its main()"));
}

TEST(Open, WhatAProgramAddsItHas) {
  const Transport file{"copy",
                       "slow",
                       "fast",
                       internal::open_file_source,
                       internal::open_file_sink,
                       internal::check_host_port};
  add_transport(file);
  add_transport(file);
  EXPECT_EQ(std::ranges::count(transports(), "copy"), 1);
  EXPECT_EQ(open_source(*parse_uri("copy:/nowhere?slow=1")).error().code, Code::NotFound);
  EXPECT_EQ(open_sink(*parse_uri("copy:/nowhere?slow=1")).error().detail,
            "copy has no option \"slow\" here, only \"fast\"");
  EXPECT_EQ(check_sink(*parse_uri("copy:/nowhere?fast=1")).error().code, Code::Invalid);
}

TEST(Open, OptionsAreChecked) {
  EXPECT_EQ(open_source(*parse_uri("tcp:localhost:1?speed=3")).error().detail,
            "tcp has no option \"speed\" here, only \"wait\", \"reconnect\", \"same_user\"");
  EXPECT_EQ(open_source(*parse_uri("tcp:h:1?wait=")).error().text(),
            "Invalid: option wait has no value");
  EXPECT_EQ(open_source(*parse_uri("-?wait=3")).error().detail, "- has no option \"wait\" here");
  EXPECT_EQ(open_source(*parse_uri("-?keep=latest")).error().code, Code::Invalid);
  EXPECT_EQ(open_sink(*parse_uri("-?wait=3")).error().detail,
            "- has no option \"wait\" here, only \"keep\", \"rate\", \"burst\", \"bandwidth\", "
            "\"memory\", "
            "\"timeout\"");
  EXPECT_EQ(open_sink(*parse_uri("-?keep=some")).error().code, Code::Invalid);
  EXPECT_EQ(open_source(*parse_uri("tcp:localhost:1?wait=x")).error().code, Code::Invalid);
  EXPECT_EQ(open_sink(*parse_uri("unix-listen:@x?readers=-1")).error().code, Code::Invalid);
}

TEST(Open, AnOptionThatIsMisspeltIsGuessed) {
  EXPECT_EQ(open_source(*parse_uri("tcp:localhost:1?recconect=3")).error().detail,
            "tcp has no option \"recconect\" here, only \"wait\", \"reconnect\", \"same_user\", "
            "did you mean \"reconnect\"?");
  for (const char* end :
       {"-", "file:x", "tcp-listen:0", "unix:@x", "unix-listen:@x", "inproc:x", "shm:x"})
    EXPECT_TRUE(open_sink(*parse_uri(std::string(end) + "?keeps=latest"))
                    .error()
                    .detail.ends_with(", did you mean \"keep\"?"))
        << end;
  // An option of the other end is not a spelling mistake.
  EXPECT_TRUE(open_sink(*parse_uri("shm:x?spin=1")).error().detail.ends_with("\"timeout\""));
}

TEST(Open, NumbersHaveARange) {
  auto source_error = [](const std::string& uri) {
    return open_source(*parse_uri(uri)).error().text();
  };
  auto sink_error = [](const std::string& uri) {
    return open_sink(*parse_uri(uri)).error().text();
  };
  for (const char* end : {"tcp:localhost:1", "unix:@nobody", "shm:nobody"})
    for (std::string option : {"wait", "reconnect"})
      EXPECT_EQ(source_error(end + ("?" + option) + "=86401"),
                "Invalid: option " + option + " is a whole number from 0 to 86400, not \"86401\"");
  EXPECT_EQ(sink_error("tcp-listen:0?readers=257"),
            "Invalid: option readers is a whole number from 0 to 256, not \"257\"");
  EXPECT_EQ(sink_error("unix-listen:@x?readers=257"),
            "Invalid: option readers is a whole number from 0 to 256, not \"257\"");
  EXPECT_EQ(sink_error("shm:x?readers=65"),
            "Invalid: option readers is a whole number from 0 to 64, not \"65\"");
  EXPECT_EQ(sink_error("-?burst=2"), "Invalid: option burst needs rate");
}

TEST(Open, SharedMemoryHasAName) {
  EXPECT_EQ(open_source(*parse_uri("shm:?wait=1")).error().text(),
            "Invalid: a name of shared memory has 1 to 90 bytes, not 0");
  EXPECT_EQ(open_sink(*parse_uri("shm:")).error().code, Code::Invalid);
  EXPECT_EQ(open_sink(*parse_uri("shm:" + std::string(91, 'x'))).error().code, Code::Invalid);
  EXPECT_TRUE(open_sink(*parse_uri("shm:" + std::string(90, 'x'))));
}

TEST(Wait, GivesTheNumberOfDescriptorsWhenTimeIsUp) {
  EXPECT_EQ(*wait_readable({}, -1, std::chrono::milliseconds(1)), 0U);
}

}  // namespace
}  // namespace hc
