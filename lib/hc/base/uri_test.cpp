// SPDX-License-Identifier: Apache-2.0
#include <hc/base/uri.h>

#include <gtest/gtest.h>

#include <hc/base/place_word.h>

namespace hc {
namespace {

TEST(Uri, TakesSchemesApart) {
  auto uri = parse_uri("unix:@eye?readers=2&x=a:b");
  ASSERT_TRUE(uri);
  EXPECT_EQ(uri->scheme, "unix");
  EXPECT_EQ(uri->rest, "@eye");
  EXPECT_EQ(uri->option("readers", "1"), "2");
  EXPECT_EQ(uri->option("x", ""), "a:b");
  EXPECT_EQ(uri->option("absent", "default"), "default");
  EXPECT_EQ(uri->text(), "unix:@eye?readers=2&x=a:b");
}

TEST(Uri, AnythingWithoutASchemeIsAFile) {
  for (const char* text : {"eyes.mtp", "/tmp/a:b", "./x:y", "eyes"}) {
    auto uri = parse_uri(text);
    ASSERT_TRUE(uri) << text;
    EXPECT_EQ(uri->scheme, "file");
    EXPECT_EQ(uri->rest, text);
  }
  EXPECT_EQ(parse_uri("-")->scheme, "-");
  EXPECT_EQ(parse_uri("-")->text(), "-");
}

TEST(Uri, RefusesWhatIsNone) {
  for (std::string text : {std::string(), std::string(4097, 'x'), std::string("file:a\nb"),
                           std::string("file:a\0b", 8), std::string("A:b"), std::string("7:b"),
                           std::string("tcp:x?"), std::string("tcp:x?a"), std::string("tcp:x?=1"),
                           std::string("tcp:x?a=1&a=2"), std::string(":x"), std::string("t p:x")}) {
    auto uri = parse_uri(text);
    ASSERT_FALSE(uri) << text;
    EXPECT_EQ(uri.error().code, Code::Invalid);
    EXPECT_EQ(uri.error().detail.find('\n'), std::string::npos);
  }
}

TEST(PlaceWord, IsALinkOrAFile) {
  for (const char* word :
       {"2025-11-25T13:00:00.mtp", "Run 1: eyes.mtp", "13:00.mtp", "A:b", "x?y"}) {
    const auto place = parse_place_word(word);
    ASSERT_TRUE(place) << word;
    EXPECT_EQ(place->scheme, "file") << word;
    EXPECT_EQ(place->rest, word);
  }
  EXPECT_EQ(parse_place_word("-")->scheme, "-");
  EXPECT_EQ(parse_place_word("tcp:robot:7000?keep=3")->option("keep", ""), "3");
  EXPECT_EQ(parse_place_word("x.mtp?append=1")->rest, "x.mtp");
  for (const char* wrong : {"", "tcp:x?a", "file:x?a"})
    EXPECT_FALSE(parse_place_word(wrong)) << wrong;
}

TEST(PlaceWord, McapIsKnownByItsEnding) {
  for (const char* path : {"x.mcap", "X.MCAP", ".mcap"}) EXPECT_TRUE(is_mcap_path(path)) << path;
  for (const char* path : {"", "mcap", "x.mcap/", "x.mtp"})
    EXPECT_FALSE(is_mcap_path(path)) << path;
}

TEST(HostPort, ReadsNamesAddressesAndPorts) {
  EXPECT_EQ(parse_host_port("localhost:7000")->host, "localhost");
  EXPECT_EQ(parse_host_port("localhost:7000")->port, 7000);
  EXPECT_EQ(parse_host_port("65535")->host, "");
  EXPECT_EQ(parse_host_port("65535")->port, 65535);
  EXPECT_EQ(parse_host_port("[::1]:80")->host, "::1");
}

TEST(HostPort, RefusesWhatIsNone) {
  for (const char* text :
       {"", "x", "x:", "x:65536", "x:-1", "x:1y", "::1:80", "[::1", "[::1]", "[::1]80"})
    EXPECT_FALSE(parse_host_port(text)) << text;
}

}  // namespace
}  // namespace hc
