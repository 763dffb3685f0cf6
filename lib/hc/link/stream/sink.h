// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages into any descriptor that carries a stream of bytes. Internal: what stdio, file, tcp and
// unix share.

#include <memory>

#include <hc/link/link.h>
#include <hc/link/stream/connection.h>
#include <hc/mtp/codec.h>

namespace hc::internal {

/// Puts messages into one stream, by an Connection.
///
/// A message that was begun is finished, also when it is to stop: the reader could not tell where
/// the next one begins, and would call the stream damaged.
class StreamSink final : public Sink {
 public:
  /// @param descriptor  its writes do not wait; those of sockets never do. May be none (-1) with a
  ///     dialer, which makes the connection anew when it is lost.
  /// @param uri  for its policy.
  ///
  /// Errors: Invalid, System.
  static Result<std::unique_ptr<Sink>> make(Descriptor descriptor, const Uri& uri,
                                            const LinkOptions& options,
                                            std::unique_ptr<Dialer> dialer = nullptr);

  Status send(const Message& message) override;
  Status close() override;
  void abandon() override { connection_->abandon(); }
  [[nodiscard]] Traffic traffic() const override;

 private:
  explicit StreamSink(std::unique_ptr<Connection> connection)
      : connection_(std::move(connection)) {}

  std::unique_ptr<Connection> connection_;
  Encoder encoder_;
  std::uint64_t messages_ = 0, bytes_ = 0;
};

}  // namespace hc::internal
