// SPDX-License-Identifier: Apache-2.0
#include <hc/link/stream/sink.h>

namespace hc::internal {

Result<std::unique_ptr<Sink>> StreamSink::make(Descriptor descriptor, const Uri& uri,
                                               const LinkOptions& options,
                                               std::unique_ptr<Dialer> dialer) {
  auto policy = parse_policy(uri);
  if (!policy) return policy.error();
  auto connection = Connection::make(std::move(descriptor), *policy, options, std::move(dialer));
  if (!connection) return connection.error();
  return std::unique_ptr<Sink>(new StreamSink(std::move(*connection)));
}

Status StreamSink::send(const Message& message) {
  Outgoing outgoing(encoder_.encode(message), message);
  auto sent = connection_->send(outgoing, std::chrono::steady_clock::now());
  connection_->tell_log();
  if (!sent) return sent.error();
  ++messages_;
  bytes_ += outgoing.size();
  return {};
}

Status StreamSink::close() {
  auto closed = connection_->close();
  connection_->tell_log();
  return closed;
}

Traffic StreamSink::traffic() const {
  Traffic traffic = connection_->losses();
  traffic.messages = messages_;
  traffic.bytes += bytes_;
  return traffic;
}

}  // namespace hc::internal
