// SPDX-License-Identifier: Apache-2.0
#pragma once
// A source whose other side has not answered yet. Internal.

#include <functional>
#include <memory>

#include <hc/link/link.h>

namespace hc::internal {

/// Becomes another source when the answer is there. Whoever owes it may be stopped for long, so
/// that nobody waits for it but by the descriptor.
class AwaitingSource final : public Source {
 public:
  /// Takes the answer, never waits; null when there is none yet.
  using Begin = std::function<Result<std::unique_ptr<Source>>()>;

  /// @param descriptor  readable when the answer comes, and that of the source that comes of it.
  AwaitingSource(int descriptor, Begin begin) : descriptor_(descriptor), begin_(std::move(begin)) {}

  /// Errors: Closed, if no source comes of the answer.
  Result<Got> take(Message& message) override {
    if (source_ == nullptr) {
      message = {};
      auto source = begin_();
      if (!source) return Error{Code::Closed, source.error().detail};
      if (*source == nullptr) return Got::Nothing;
      source_ = std::move(*source);
    }
    return source_->take(message);
  }

  [[nodiscard]] int descriptor() const override { return descriptor_; }
  bool prepare_wait() override { return source_ == nullptr || source_->prepare_wait(); }
  Result<bool> wait(int stop, std::chrono::milliseconds timeout) override {
    return source_ == nullptr ? Source::wait(stop, timeout) : source_->wait(stop, timeout);
  }
  [[nodiscard]] Traffic traffic() const override {
    return source_ == nullptr ? Traffic() : source_->traffic();
  }

 private:
  int descriptor_;
  Begin begin_;
  std::unique_ptr<Source> source_;
};

}  // namespace hc::internal
