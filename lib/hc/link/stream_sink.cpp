// SPDX-License-Identifier: Apache-2.0
#include <hc/link/stream_sink.h>

namespace hc::internal {

Result<std::unique_ptr<Sink>> StreamSink::make(Descriptor descriptor, const Uri& uri,
                                               const LinkOptions& options,
                                               std::unique_ptr<Dialer> dialer) {
  auto policy = parse_policy(uri);
  if (!policy) return policy.error();
  auto outlet = Outlet::make(std::move(descriptor), *policy, options, std::move(dialer));
  if (!outlet) return outlet.error();
  return std::unique_ptr<Sink>(new StreamSink(std::move(*outlet)));
}

Status StreamSink::send(const Message& message) {
  Outgoing outgoing(encoder_.encode(message), message);
  auto sent = outlet_->send(outgoing, std::chrono::steady_clock::now());
  outlet_->tell_log();
  if (!sent) return sent.error();
  ++messages_;
  bytes_ += outgoing.size();
  return {};
}

Status StreamSink::close() {
  auto closed = outlet_->close();
  outlet_->tell_log();
  return closed;
}

Traffic StreamSink::traffic() const {
  Traffic traffic = outlet_->losses();
  traffic.messages = messages_;
  traffic.bytes += bytes_;
  return traffic;
}

}  // namespace hc::internal
