// SPDX-License-Identifier: Apache-2.0
#include "viewer.h"

#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace {

/// The client: what was sent counts as unread until read() is called.
struct FakeSocket final : hc::web::WebSocket {
  void send_text(std::string text) override { texts.push_back(std::move(text)); }
  void send(hc::web::Bytes message, std::string head) override {
    sent.push_back(std::move(head) + *message);
    ++under_way;
  }
  void close(int code, std::string) override { closed = code; }
  [[nodiscard]] std::size_t waiting() const override { return under_way + texts.size(); }
  void read() {
    under_way = 0;
    texts.clear();
    on_sent();
  }
  std::vector<std::string> texts, sent;
  std::size_t under_way = 0;
  int closed = 0;
};

struct ViewerTest : ::testing::Test {
  std::shared_ptr<FakeSocket> socket = std::make_shared<FakeSocket>();
  Viewer viewer{socket, hc::web::Right::View};
  Channel channel{7, "/eyes/left", "eyes.left", hc::ros::Type::Image};

  static Payload payload(const std::string& bytes, hc::Time time = hc::unix_time(1)) {
    return {time, std::make_shared<const std::string>(bytes)};
  }
};

TEST_F(ViewerTest, a_message_has_its_subscription_and_time) {
  ASSERT_TRUE(viewer.subscribe(3, channel));
  viewer.offer(7, payload("abc", hc::unix_time(0x0102030405060708)));
  ASSERT_EQ(socket->sent.size(), 1u);
  EXPECT_EQ(socket->sent[0],
            std::string("\x01\x03\0\0\0\x08\x07\x06\x05\x04\x03\x02\x01", 13) + "abc");
}

TEST_F(ViewerTest, of_other_channels_nothing_is_sent) {
  viewer.offer(7, payload("abc"));
  EXPECT_TRUE(socket->sent.empty());
}

TEST_F(ViewerTest, a_channel_is_subscribed_once) {
  EXPECT_TRUE(viewer.subscribe(3, channel));
  EXPECT_FALSE(viewer.subscribe(4, channel));
  EXPECT_FALSE(viewer.subscribe(3, {8, "/b", "b.b", hc::ros::Type::String}));
  viewer.unsubscribe(3);
  EXPECT_TRUE(viewer.subscribe(4, channel));
}

TEST_F(ViewerTest, of_large_messages_the_newest_waits) {
  ASSERT_TRUE(viewer.subscribe(3, channel));
  for (char c = 'a'; c <= 'f'; ++c) viewer.offer(7, payload(std::string(100'000, c)));
  EXPECT_EQ(socket->sent.size(), 2u);
  socket->read();
  ASSERT_EQ(socket->sent.size(), 3u);
  EXPECT_EQ(socket->sent[2].back(), 'f');
  viewer.report_dropped();
  ASSERT_EQ(socket->texts.size(), 1u);
  EXPECT_NE(socket->texts[0].find("3 messages of /eyes/left were dropped"), std::string::npos);
  viewer.report_dropped();  // once
  EXPECT_EQ(socket->texts.size(), 1u);
}

TEST_F(ViewerTest, of_small_messages_1024_wait) {
  ASSERT_TRUE(viewer.subscribe(3, channel));
  for (int i = 0; i < 2000; ++i) viewer.offer(7, payload(std::to_string(i)));
  while (socket->under_way > 0) socket->read();
  EXPECT_EQ(socket->sent.size(), 1026u);
  EXPECT_EQ(socket->sent.back().substr(13), "1999");
}

TEST_F(ViewerTest, who_does_not_read_is_disconnected) {
  for (int i = 0; i < 600 && !viewer.is_lost(); ++i) viewer.say("{}");
  EXPECT_TRUE(viewer.is_lost());
  EXPECT_EQ(socket->closed, 1008);
}

TEST_F(ViewerTest, a_channel_that_ends_takes_what_waits_with_it) {
  ASSERT_TRUE(viewer.subscribe(3, channel));
  for (int i = 0; i < 5; ++i) viewer.offer(7, payload("a"));
  viewer.forget(7);
  socket->read();
  EXPECT_EQ(socket->sent.size(), 2u);
}

}  // namespace
