// SPDX-License-Identifier: Apache-2.0
#include <hc/link/stream/connection.h>
#include <hc/link/stream/ends.h>
#include <hc/mtp/codec.h>

namespace hc::internal {
namespace {

class StreamSink final : public Sink {
 public:
  explicit StreamSink(std::unique_ptr<Connection> connection)
      : connection_(std::move(connection)) {}

  Status send(const Message& message) override {
    Outgoing outgoing(encoder_.encode(message), message);
    auto sent = connection_->send(outgoing, std::chrono::steady_clock::now());
    connection_->flush_log();
    if (!sent) return sent.error();
    ++messages_;
    bytes_ += outgoing.size();
    return {};
  }

  Status close() override {
    auto closed = connection_->close();
    connection_->flush_log();
    return closed;
  }

  void abandon() override { connection_->abandon(); }

  std::optional<std::size_t> peers() override { return connection_->is_connected() ? 1 : 0; }

  [[nodiscard]] Traffic traffic() const override {
    Traffic traffic = connection_->losses();
    traffic.messages = messages_;
    traffic.bytes += bytes_;
    return traffic;
  }

 private:
  std::unique_ptr<Connection> connection_;
  Encoder encoder_;
  std::uint64_t messages_ = 0, bytes_ = 0;
};

}  // namespace

Result<std::unique_ptr<Sink>> make_stream_sink(ConnectedSocket descriptor, const Uri& uri,
                                               const LinkOptions& options,
                                               std::unique_ptr<Dialer> dialer) {
  auto policy = HC_TRY(parse_policy(uri));
  auto connection =
      HC_TRY(Connection::make(std::move(descriptor), policy, options, std::move(dialer)));
  return std::unique_ptr<Sink>(new StreamSink(std::move(connection)));
}

}  // namespace hc::internal
