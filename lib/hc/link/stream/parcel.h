// SPDX-License-Identifier: Apache-2.0
#pragma once
// An encoded message, shared by all connections that send it. Internal.

#include <cstddef>
#include <memory>
#include <vector>

#include <hc/mtp/codec.h>

namespace hc::internal {

/// The bytes of an encoded message.
struct Parcel {
  /// Messages up to this size are copied, which takes no longer than a system call. [byte]
  static constexpr std::size_t kMostCopied = 8 << 10;

  Pieces pieces;
  std::shared_ptr<const void> owner;  ///< of the pieces; null: the caller keeps them alive

  [[nodiscard]] std::size_t size() const {
    return pieces[0].size() + pieces[1].size() + pieces[2].size();
  }
};

/// A message that is being sent, to one reader or several.
class Outgoing {
 public:
  /// @param pieces  of `message`; both must outlive this object.
  Outgoing(const Pieces& pieces, const Message& message)
      : message_(message), borrowed_{pieces, nullptr} {}

  [[nodiscard]] const Parcel& borrowed() const { return borrowed_; }
  [[nodiscard]] std::size_t size() const { return borrowed_.size(); }

  /// The same with an owner. The first call copies the elements, unless they have an owner.
  /// Cost: two or three allocations.
  const Parcel& kept() {
    if (kept_.owner != nullptr) return kept_;
    struct Copy {
      std::vector<std::byte> bytes;
      Message message;
    };
    auto copy = std::make_shared<Copy>();
    const auto& [head, elements, end] = borrowed_.pieces;
    copy->bytes.assign(head.begin(), head.end());
    if (elements.size() <= Parcel::kMostCopied) {
      copy->bytes.insert(copy->bytes.end(), elements.begin(), elements.end());
      copy->bytes.insert(copy->bytes.end(), end.begin(), end.end());
      kept_.pieces = {copy->bytes, {}, {}};
    } else {
      copy->message = message_.keep();
      kept_.pieces = {copy->bytes, copy->message.elements, end};  // the end is a constant
    }
    kept_.owner = std::move(copy);
    return kept_;
  }

 private:
  const Message& message_;
  Parcel borrowed_, kept_;
};

}  // namespace hc::internal
