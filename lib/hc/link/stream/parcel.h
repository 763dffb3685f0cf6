// SPDX-License-Identifier: Apache-2.0
#pragma once
// A message on its way out, encoded once for all who get it. Internal.

#include <memory>
#include <vector>

#include <hc/link/stream/writer.h>
#include <hc/mtp/codec.h>

namespace hc::internal {

/// Bytes of a message that somebody keeps alive.
struct Parcel {
  Pieces pieces;
  std::shared_ptr<const void> keeper;  ///< null: whoever has handed it in

  [[nodiscard]] std::size_t size() const { return size_of(pieces); }
};

/// A message that is sent, perhaps to several.
class Outgoing {
 public:
  /// @param pieces  of `message`; both live as long as this.
  Outgoing(const Pieces& pieces, const Message& message)
      : message_(message), borrowed_{pieces, nullptr} {}

  [[nodiscard]] const Parcel& borrowed() const { return borrowed_; }
  [[nodiscard]] std::size_t size() const { return borrowed_.size(); }

  /// The same to be held as long as one likes. Elements with an owner are shared, others copied,
  /// by the first call. Cost: two allocations, or three.
  const Parcel& kept() {
    if (kept_.keeper != nullptr) return kept_;
    struct Copy {
      std::vector<std::byte> bytes;
      Message message;
    };
    auto copy = std::make_shared<Copy>();
    const auto& [head, elements, end] = borrowed_.pieces;
    copy->bytes.assign(head.begin(), head.end());
    if (elements.size() <= StreamWriter::kMostCopied) {
      copy->bytes.insert(copy->bytes.end(), elements.begin(), elements.end());
      copy->bytes.insert(copy->bytes.end(), end.begin(), end.end());
      kept_.pieces = {copy->bytes, {}, {}};
    } else {
      copy->message = message_.keep();
      kept_.pieces = {copy->bytes, copy->message.elements, end};  // the end is a constant
    }
    kept_.keeper = std::move(copy);
    return kept_;
  }

 private:
  const Message& message_;
  Parcel borrowed_, kept_;
};

}  // namespace hc::internal
