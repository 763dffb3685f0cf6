// SPDX-License-Identifier: Apache-2.0
#include <hc/link/stream_sink.h>

namespace hc::internal {

Result<std::unique_ptr<Sink>> StreamSink::make(Descriptor descriptor, const Uri& uri,
                                               const LinkOptions& options,
                                               std::unique_ptr<Dialer> dialer) {
  auto policy = parse_policy(uri);
  if (!policy) return policy.error();
  auto outlet = Outlet::make(std::move(descriptor), *policy, options.stop, std::move(dialer));
  if (!outlet) return outlet.error();
  return std::unique_ptr<Sink>(new StreamSink(std::move(*outlet), options.log));
}

Status StreamSink::send(const Message& message) {
  Outgoing outgoing(encoder_.encode(message), message);
  auto sent = outlet_->send(outgoing, std::chrono::steady_clock::now());
  if (log_) tell_log();
  if (!sent) return sent.error();
  ++messages_;
  bytes_ += outgoing.size();
  return {};
}

Status StreamSink::close() {
  auto closed = outlet_->close();
  tell_log();
  return closed;
}

void StreamSink::tell_log() {
  if (!outlet_->has_remarks() || !log_) return;
  for (const auto& line : outlet_->take_remarks()) log_(Severity::Warning, line);
}

Traffic StreamSink::traffic() const {
  Traffic traffic = outlet_->losses();
  traffic.messages = messages_;
  traffic.bytes = bytes_;
  return traffic;
}

}  // namespace hc::internal
