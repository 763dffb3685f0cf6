// SPDX-License-Identifier: Apache-2.0
#pragma once
// Ports: where a module's messages come in and go out.

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/clock.h>
#include <hc/contract/conversion.h>
#include <hc/link/link.h>
#include <hc/module/kind.h>
#include <hc/module/matcher.h>
#include <hc/module/route.h>

namespace hc {

class Module;

namespace internal {

struct TogetherState;

/// A link by which messages of an output leave.
struct Outlet {
  std::string uri, port;
  std::unique_ptr<Sink> sink;  ///< null once the reader has disconnected
  Conversion conversion;       ///< of its messages
  Traffic traffic;             ///< as it was when the link ended
  std::int64_t peers = -1;     ///< at the last report; see LinkCounters
  Route route;                 ///< which messages it takes

  void end() {
    traffic = sink->traffic();
    sink.reset();
  }
};

struct InputState {
  std::string name, doc;
  std::vector<PortType> types;            ///< what it takes; empty: anything
  std::function<void(Message&)> handler;  ///< may move the message away
  TogetherState* together = nullptr;      ///< with the inputs that are taken together with this one
  std::size_t place = 0;                  ///< of this one among them
  bool is_unmatched = false;  ///< a message was dropped for want of a partner, and it is logged
  bool is_raw = false;        ///< the handler gets messages as they came, compressed ones too
  bool is_actor = false;      ///< moves something: one writer at a time is to have it
  bool is_exclusive = false;  ///< takes messages of the mode in focus alone
  bool is_finite = false;     ///< drops messages with NaN or infinity
  std::uint32_t keep = 0;     ///< see Module::keep(); 0: not said
};

/// What an output takes over from the message that is being handled.
struct Handled {
  std::int64_t time = 0;
  std::int32_t mode = 0;
  std::int32_t coord = 0;
  MatrixType type{};  ///< of the message
  /// Address of the graph from which it came, for a link between graphs; null: unknown.
  const std::string* peer = nullptr;

  Handled() = default;
  explicit Handled(const Header& header, const std::string* from = nullptr)
      : time(header.time),
        mode(header.mode),
        coord(header.coord),
        type(header.info.type),
        peer(from) {}

  /// The coordinate system of a message of another type that is made out of it: its own, where both
  /// are of one type, or images; 0 otherwise, since a score of an image is not in pixels.
  [[nodiscard]] std::int32_t coord_for(MatrixType made) const {
    auto is_image = [](MatrixType each) {
      return each == MatrixType::RgbImage || each == MatrixType::IntensityImage;
    };
    return made == type || (is_image(made) && is_image(type)) ? coord : 0;
  }
};

/// Inputs that are taken together.
struct TogetherState {
  std::vector<std::shared_ptr<InputState>> inputs;
  Matcher::Take handler;
  Matcher matcher;
  /// Only the newest complete set is handled: a link of theirs has keep=latest.
  bool is_latest = false;
  std::vector<Message> set;         ///< complete, to be handled; empty: none
  std::uint64_t dropped_newer = 0;  ///< complete sets that were dropped for a newer one
};

struct OutputState {
  std::string name, doc;
  std::vector<PortType> types;       ///< the one that it gives; empty: anything
  std::int32_t address = 0;          ///< src of its messages
  std::int32_t to = 0;               ///< dst of those that have none
  std::optional<Encoding> encoding;  ///< asked for on the command line
  bool is_on_demand = false;         ///< see Module::on_demand()
  std::uint32_t keep = 0;            ///< see Module::never_waits(); 0: it waits as its links say
  std::int64_t seq = 0;
  std::vector<std::shared_ptr<Outlet>> links;
  Module* module = nullptr;

  [[nodiscard]] const PortType& type() const { return types.at(0); }
};

/// Completes the header and sends to all links. What fails ends the module.
void send(OutputState& output, Message&& message);

/// Sends a message as it is; see Output<AnyKind>::forward.
std::size_t forward(OutputState& output, const Message& message);

}  // namespace internal

/// An input port of kind K.
template <typename K>
class Input {
 private:
  friend class Module;
  template <typename... Kinds>
  friend class Together;
  explicit Input(std::shared_ptr<internal::InputState> state) : state_(std::move(state)) {}

  std::shared_ptr<internal::InputState> state_;
};

/// Inputs whose messages of equal times are taken together; see Matcher for the rules.
template <typename... Kinds>
class Together {
 public:
  explicit Together(const Input<Kinds>&... inputs) : inputs_{inputs.state_...} {}

 private:
  friend class Module;
  std::vector<std::shared_ptr<internal::InputState>> inputs_;
};

/// Two inputs or more, of any kinds, for Module::on().
template <typename... Kinds>
requires(sizeof...(Kinds) >= 2) Together<Kinds...> together(const Input<Kinds>&... inputs) {
  return Together<Kinds...>(inputs...);
}

/// An output port of kind K.
template <typename K>
class Output {
 public:
  explicit Output(std::shared_ptr<internal::OutputState> state) : state_(std::move(state)) {}

  /// Sends a message to every link of the port. The header's src, seq and encoding are filled in;
  /// dst, mode, coord and time where they are 0: dst by `--to`, mode and time by those of the
  /// message being handled, since what is derived from a message keeps its time; and coord by the
  /// port's, else by that of the message being handled where both are images or of one type.
  void send(MessageOf<K> message) { internal::send(*state_, std::move(message)); }
  void send(DraftOf<K>&& draft) { internal::send(*state_, std::move(draft).finish()); }

  /// A message to be written in place and sent, which saves a copy of large elements.
  [[nodiscard]] DraftOf<K> loan(std::int32_t width, std::int32_t height) const {
    Header header;
    header.info = state_->type().info;
    header.width = width;
    header.height = height;
    for (const auto& link : state_->links)
      if (link->sink != nullptr && link->conversion.is_none()) return {link->sink->loan(header)};
    return {Draft::make(header)};
  }

  /// Whether the output has a reader; a module may save itself the work otherwise.
  [[nodiscard]] bool linked() const {
    return std::any_of(state_->links.begin(), state_->links.end(),
                       [](const auto& link) { return link->sink != nullptr; });
  }

 private:
  friend class Module;
  std::shared_ptr<internal::OutputState> state_;
};

/// An output port that passes on messages of any kind: of a router, a gateway, a filter.
template <>
class Output<AnyKind> {
 public:
  explicit Output(std::shared_ptr<internal::OutputState> state) : state_(std::move(state)) {}

  /// Sends a message, header and elements as they are, to the links whose route takes its dst, but
  /// not back to the peer from which the message being handled came. A link without a route takes
  /// everything.
  /// @returns  how many links took it.
  std::size_t forward(const Message& message) { return internal::forward(*state_, message); }

  /// What `--encoding` asked for; forward() does not see to it.
  [[nodiscard]] std::optional<Encoding> encoding() const { return state_->encoding; }

 private:
  std::shared_ptr<internal::OutputState> state_;
};

}  // namespace hc
