// SPDX-License-Identifier: Apache-2.0
#pragma once
// Ports: where a module's messages come in and go out.

#include <algorithm>
#include <deque>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <hc/base/clock.h>
#include <hc/contract/conversion.h>
#include <hc/link/link.h>
#include <hc/module/kind.h>
#include <hc/module/matcher.h>
#include <hc/module/route.h>

namespace hc {

class Module;

/// What a graph is to know of an input.
struct InputOptions {
  /// It moves something: a graph with several writers to it needs an arbiter (`exclusive`, a
  /// router).
  bool actor = false;
  /// > 0: only so many of the newest messages count while the module is busy, so that no link to it
  /// in a graph makes its writer wait, unless the link says otherwise. For setpoints, bids,
  /// commands of a person. Where several sources share a link, enough for one of each.
  std::uint32_t keep = 0;
};

struct OutputOptions {
  /// It is sent only by a link to it alone, and has no part in the standard output that outputs
  /// share: it costs time, and few readers want it.
  bool on_demand = false;
  /// > 0: sending never waits, whatever its links say. Without a reader a message is lost, and for
  /// a slow reader so many of the newest wait. For a module that has other work to do in time.
  std::uint32_t keep = 0;
  /// Names of the numbers in a row, with their units: "age [s]". The next numbers repeat them.
  std::vector<std::string> columns{};
};

namespace internal {

struct TogetherState;
struct AdaptedLinks;
class IdleRate;

/// A link by which messages of an output leave.
struct Outlet {
  std::string uri, port;
  std::unique_ptr<Sink> sink;             ///< null once the reader has disconnected
  Conversion conversion;                  ///< of its messages
  std::shared_ptr<AdaptedLinks> adapted;  ///< to its bandwidth; null: not
  std::shared_ptr<IdleRate> idle;         ///< null: it does not slow down
  std::uint64_t thinned = 0;              ///< messages dropped by these two
  Traffic traffic;                        ///< as it was when the link ended
  std::int64_t peers = -1;                ///< at the last report; see LinkCounters
  Route route;                            ///< which messages it takes
  std::int64_t first = 0;                 ///< OutputState::seq of the first message it takes

  /// What its sink has counted, or had when the link ended.
  [[nodiscard]] Traffic counted() const {
    Traffic all = sink ? sink->traffic() : traffic;
    all.messages += thinned;
    all.throttled += thinned;
    return all;
  }
  void end() {
    traffic = sink->traffic();
    sink.reset();
  }
};

/// A message that waits to be pulled. @see Inlet::number
struct Waiting {
  Message message;
  std::int32_t inlet = 0;
};

struct InputState {
  std::string name, doc;
  std::vector<PortType> types;            ///< what it takes; empty: anything
  std::function<void(Message&)> handler;  ///< may move the message away
  TogetherState* together = nullptr;      ///< with the inputs that are taken together with this one
  std::size_t place = 0;                  ///< of this one among them
  bool is_unmatched = false;  ///< a message was dropped for want of a partner, and it is logged
  bool is_raw = false;        ///< the handler gets messages as they came, compressed ones too
  bool is_exclusive = false;  ///< takes messages of the mode in focus alone
  bool is_finite = false;     ///< drops messages with NaN or infinity
  bool is_pulled = false;     ///< messages wait until they are asked for: Run::next()
  std::int32_t links = 0;     ///< of its own that are open
  std::deque<Waiting> waiting;
  InputOptions options;
};

/// What an output takes over from the message that is being handled.
struct Handled {
  Time time;
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
  bool is_starving = false;         ///< there are no sets, and it is logged
};

struct OutputState {
  std::string name, doc;
  std::vector<PortType> types;       ///< the one that it gives; empty: anything
  std::int32_t address = 0;          ///< src of its messages
  std::int32_t to = 0;               ///< dst of those that have none
  std::optional<Encoding> encoding;  ///< asked for on the command line
  OutputOptions options;
  std::int64_t seq = 0;  ///< messages sent or forwarded
  std::vector<std::shared_ptr<Outlet>> links;
  Module* module = nullptr;

  [[nodiscard]] const PortType& type() const { return types.at(0); }
};

/// A number that a scalar holds: without narrowing, or an integer as floating point.
template <typename Number, typename Scalar>
concept HeldBy = std::is_arithmetic_v<Number> &&
    ((std::floating_point<Scalar> && std::integral<Number>) ||
     requires(Number number) { Scalar{number}; });

/// Completes the header and sends to all links. What fails ends the module.
void send(OutputState& output, Message&& message);

/// Sends a message as it is; see Output<AnyKind>::forward.
std::size_t forward(OutputState& output, const Message& message);

}  // namespace internal

/// An input port of kind K.
template <typename K>
class Input {
 public:
  /// Whether it has a link of its own that has not ended, so that a message can still come by it.
  /// Standard input is not one, as inputs share it.
  [[nodiscard]] bool linked() const { return state_->links > 0; }

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
///
/// What is sent gets a header: src, seq and encoding always; dst, mode, coord and time where they
/// are 0: dst by `--to`, mode and time by those of the message being handled, since what is derived
/// from a message keeps its time; and coord by the port's, else by that of the message being
/// handled where both are images or of one type.
template <typename K>
class Output {
 public:
  using Scalar = typename K::Scalar;

  explicit Output(std::shared_ptr<internal::OutputState> state) : state_(std::move(state)) {}

  /// Sends one number, which the port's scalar can hold.
  ///
  ///     mean.send(average);
  ///
  /// @param time  when what it says happened; Time{}: see above.
  /// @param coord  its coordinate system; 0: see above.
  template <internal::HeldBy<Scalar> Number>
  void send(Number number, Time time = {}, std::int32_t coord = 0) {
    send({static_cast<Scalar>(number)}, time, coord);
  }
  /// Sends numbers, row by row, in the shape of the port: see Kind::message().
  ///
  ///     command.send({0, tilt, pan}, module.now());
  void send(std::initializer_list<Scalar> numbers, Time time = {}, std::int32_t coord = 0) {
    send(K(state_->type()).message(numbers), time, coord);
  }
  void send(std::span<const Scalar> numbers, Time time = {}, std::int32_t coord = 0) {
    send(K(state_->type()).message(numbers), time, coord);
  }
  /// 0 is no text.
  void send(std::nullptr_t, Time time = {}, std::int32_t coord = 0) = delete;
  /// Sends one row of text.
  void send(std::string_view text, Time time = {},
            std::int32_t coord = 0) requires(std::is_same_v<K, StringKind>) {
    send(K(state_->type()).message(text), time, coord);
  }
  /// Sends a message; a time of Time{} and a coord of 0 leave its own.
  void send(MessageOf<K> message, Time time = {}, std::int32_t coord = 0) {
    if (time != Time()) message.header.time = time;
    if (coord != 0) message.header.coord = coord;
    internal::send(*state_, std::move(message));
  }
  /// Sends what loan() gave.
  void send(DraftOf<K>&& draft) { internal::send(*state_, std::move(draft).finish()); }

  /// A message to be written in place and sent, which saves a copy of large elements.
  [[nodiscard]] DraftOf<K> loan(std::int32_t height, std::int32_t width) const {
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
