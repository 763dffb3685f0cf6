// SPDX-License-Identifier: Apache-2.0
#pragma once
// A source that outlives its connection. Internal.

#include <functional>
#include <memory>

#include <hc/link/link.h>
#include <hc/link/stream/dialer.h>
#include <hc/os/loop.h>

namespace hc::internal {

/// Takes messages from a peer that it connects to, and to again when the connection is lost, until
/// the dialer gives up; then it ends, or fails with NotFound if there never was a connection. What
/// has come of a message by then is of no use: the peer sends it anew, or not at all.
///
/// The end that a peer says cannot be told from that of a process that was killed, so both lead to
/// trying again.
class DialingSource final : public Source {
 public:
  /// Makes the source of a connection; one that it cannot be made of counts as lost.
  using Open = std::function<Result<std::unique_ptr<Source>>(Descriptor connection)>;

  struct Made {
    Open open;
    int wake_descriptor = -1;  ///< of all sources that come of it
  };

  /// Errors: System.
  static Result<std::unique_ptr<Source>> make(std::unique_ptr<Dialer> dialer, Made made,
                                              const LinkOptions& options);

  Result<Got> take(Message& message) override;
  [[nodiscard]] int descriptor() const override { return loop_->descriptor(); }
  bool prepare_wait() override { return source_ == nullptr || source_->prepare_wait(); }
  [[nodiscard]] int wake_descriptor() const override { return made_.wake_descriptor; }
  [[nodiscard]] Spin spin() const override { return source_ == nullptr ? Spin() : source_->spin(); }
  [[nodiscard]] Traffic traffic() const override;
  void finish() override { finishing_ = true; }

 private:
  DialingSource(std::unique_ptr<Dialer> dialer, Made made, std::unique_ptr<Loop> loop,
                LinkOptions options)
      : dialer_(std::move(dialer)),
        made_(std::move(made)),
        loop_(std::move(loop)),
        options_(std::move(options)) {}

  Status dial();
  /// @param why  empty: the writer said its end.
  void lose_connection(const std::string& why);
  void watch(int descriptor, std::uint32_t events);
  void log(std::string_view line) const;

  std::unique_ptr<Dialer> dialer_;
  Made made_;
  std::unique_ptr<Loop> loop_;  // of what follows; calls nothing, but its descriptor tells
  Loop::Handle watch_;          // of the connection, or the attempt at one
  Loop::Handle retry_;
  LinkOptions options_;
  std::unique_ptr<Source> source_;  // null: there is no connection
  TimePoint connected_at_;
  TimePoint tell_at_ = TimePoint::max();  // that the sender closed
  bool finishing_ = false;                // the peer will not come back
  bool ended_ = false;
  Traffic past_;  // of connections that were lost
};

}  // namespace hc::internal
