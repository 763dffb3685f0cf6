// SPDX-License-Identifier: Apache-2.0
#pragma once
// Ports: where a module's messages come in and go out.

#include <algorithm>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/clock.h>
#include <hc/link/link.h>
#include <hc/node/kind.h>

namespace hc {

class Module;

namespace internal {

/// One end of a link, at a port.
struct LinkedSink {
  std::string uri;
  std::unique_ptr<Sink> sink;  ///< null once the reader has gone
  Traffic traffic;             ///< as it was when the link ended
};

struct InputState {
  std::string name, doc;
  std::vector<PortType> types;  ///< what it takes; empty: anything
  std::function<void(const Message&)> handler;
  std::deque<Message> waiting;  ///< for their partners, at inputs that are taken together
  std::uint64_t alone = 0;      ///< messages that found none
};

struct OutputState {
  std::string name, doc;
  PortType type;
  std::int32_t address = 0;
  std::optional<Encoding> encoding;  ///< asked for on the command line
  std::int64_t seq = 0;
  std::vector<std::shared_ptr<LinkedSink>> links;
  Module* module = nullptr;
};

/// Completes the header and sends to all links. What fails ends the module.
void send(OutputState& output, Message message);

}  // namespace internal

/// An input port of kind K.
template <typename K>
struct Input {
  std::shared_ptr<internal::InputState> state;
};

/// An output port of kind K.
template <typename K>
class Output {
 public:
  explicit Output(std::shared_ptr<internal::OutputState> state) : state_(std::move(state)) {}

  /// Sends a message to every link of the port. The header's src, seq, mode and encoding are filled
  /// in; coord and time where they are 0: coord by the port's, time by that of the message which
  /// is being handled, since what is derived from a message keeps its time.
  void send(const MessageOf<K>& message) { internal::send(*state_, message); }
  void send(DraftOf<K>&& draft) { internal::send(*state_, std::move(draft).finish()); }

  /// A message to be filled in place and sent, which saves a copy of large elements.
  [[nodiscard]] DraftOf<K> loan(std::int32_t width, std::int32_t height) const {
    Header header;
    header.info = state_->type.info;
    header.width = width;
    header.height = height;
    for (const auto& link : state_->links)
      if (link->sink != nullptr) return {link->sink->loan(header)};
    return {Draft::make(header)};
  }

  /// Whether anybody takes what is sent; a module may save itself the work otherwise.
  [[nodiscard]] bool linked() const {
    return std::any_of(state_->links.begin(), state_->links.end(),
                       [](const auto& link) { return link->sink != nullptr; });
  }

 private:
  std::shared_ptr<internal::OutputState> state_;
};

}  // namespace hc
