// SPDX-License-Identifier: Apache-2.0
#include "stream.h"

#include <unistd.h>

#include <future>
#include <latch>
#include <thread>

#include <gtest/gtest.h>

#include <hc/contract/graph_command.h>
#include <hc/module/kind.h>

namespace {

/// A stand-in for a running graph with one output, `m.p`.
class Observed {
 public:
  const hc::RunningGraph graph{"stream_test", static_cast<int>(::getpid())};

  ~Observed() { thread_.join(); }

 private:
  static hc::Uri uri(const std::string& text) { return *hc::parse_uri(text); }

  /// Accepts a connection to the output and sends a number.
  void run() {
    hc::Message asked;
    while (*commands_->take(asked) != hc::Got::Message) ASSERT_TRUE(commands_->wait());
    auto answer = hc::make_answer({true, {"unix:" + place_}});
    answer.header.seq = asked.header.seq;
    const auto reply = *hc::open_sink(uri(hc::read_request(asked).reply));
    ASSERT_TRUE(reply->send(answer));
    ASSERT_TRUE(reply->close());
    ASSERT_TRUE(numbers_->send(hc::table().message({1.0})));
  }

  const std::string place_ = "@" + graph.socket_name() + ".m.p";
  std::unique_ptr<hc::Source> commands_ =
      *hc::open_source(uri("unix-listen:" + graph.command_uri().substr(5)));
  std::unique_ptr<hc::Sink> numbers_ = *hc::open_sink(uri("unix-listen:" + place_));
  std::thread thread_{[this] { run(); }};
};

/// A page's socket, which records the thread of its end.
class PageSocket final : public web::WebSocket {
 public:
  explicit PageSocket(std::thread::id& ended) : ended_(ended) {}
  ~PageSocket() override { ended_ = std::this_thread::get_id(); }
  void send_text(std::string /*text*/) override {}
  void send(web::Bytes /*message*/, std::string /*head*/) override {}
  void close(int /*code*/, std::string /*reason*/) override {}
  [[nodiscard]] std::size_t waiting() const override { return 0; }

 private:
  std::thread::id& ended_;
};

TEST(Stream, the_socket_of_a_page_ends_on_the_servers_thread_though_the_tap_serves_the_page) {
  Observed observed;
  std::promise<void> serves;
  std::latch left(1);
  std::once_flag once;
  // Called on the tap's thread, which keeps its state of the page alive.
  Stream stream(observed.graph, "m.p", [&](const std::function<void()>&) {
    std::call_once(once, [&] { serves.set_value(); });
    left.wait();
  });
  std::thread::id ended;
  auto socket = std::make_shared<PageSocket>(ended);
  auto& events = *socket;
  stream.view({}, std::move(socket));
  serves.get_future().wait();
  const auto closed = std::exchange(events.on_close, nullptr);
  closed();
  EXPECT_FALSE(stream.is_viewed());
  left.count_down();
  stream.stop();
  EXPECT_EQ(ended, std::this_thread::get_id());
}

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
