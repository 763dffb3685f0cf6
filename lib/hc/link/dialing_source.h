// SPDX-License-Identifier: Apache-2.0
#pragma once
// A source that outlives its connection. Internal.

#include <memory>

#include <hc/link/dialer.h>
#include <hc/link/stream_link.h>

namespace hc::internal {

/// Takes messages from a peer that it connects to, and to again when the connection is lost, until
/// the dialer gives up; then it ends. What has come of a message by then is of no use: the peer
/// sends it anew, or not at all.
///
/// The end that a peer says cannot be told from that of a process that was killed, so both lead to
/// trying again.
class DialingSource final : public Source {
 public:
  /// Errors: System.
  static Result<std::unique_ptr<Source>> make(std::unique_ptr<Dialer> dialer,
                                              const LinkOptions& options);

  Result<Got> take(Message& message) override;
  [[nodiscard]] int descriptor() const override { return poll_.get(); }
  [[nodiscard]] Traffic traffic() const override;

 private:
  DialingSource(std::unique_ptr<Dialer> dialer, Descriptor poll, Descriptor timer,
                LinkOptions options)
      : dialer_(std::move(dialer)),
        poll_(std::move(poll)),
        timer_(std::move(timer)),
        options_(std::move(options)) {}

  Status dial();
  void lose_connection(const std::string& why);
  void watch(int descriptor, std::uint32_t events) const;
  void log(std::string_view line) const;

  std::unique_ptr<Dialer> dialer_;
  Descriptor poll_;   // an epoll instance of the connection, or the try at one, and the timer
  Descriptor timer_;  // says when to try again
  LinkOptions options_;
  std::unique_ptr<StreamSource> source_;  // null: there is no connection
  TimePoint connected_at_;
  bool ended_ = false;
  Traffic past_;  // of connections that were lost
};

}  // namespace hc::internal
