// SPDX-License-Identifier: Apache-2.0
#include "driver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include <hc/module/kind.h>
#include <people/person_name.h>

namespace {

using hc::Coord;

bool is_finite(const hc::Message& message) {
  const auto numbers = hc::view<double>(message);
  return numbers &&
         std::ranges::all_of(numbers->numbers(), [](double x) { return std::isfinite(x); });
}

bool is(const hc::Message& message, hc::MatrixType type, int components, int width = 1) {
  const auto& header = message.header;
  return header.info.type == type && header.info.components == components && message.plain() &&
         header.info.scalar == hc::Scalar::F64 && header.width == width && header.height == 1 &&
         is_finite(message);
}

std::span<const double> numbers_of(const hc::Message& message) {
  return hc::view<double>(message)->numbers();
}

constexpr std::size_t kMaxText = 4096;  // [byte]

/// Whether a text is "TRACK NAME".
bool is_track_and_name(std::string_view text) {
  const auto named = hc::people::numbered_name(text);
  return named && hc::people::is_person_name(named->name);
}

bool is_track(double number) {
  return number >= 0 && number <= std::numeric_limits<std::int32_t>::max() &&
         number == std::floor(number);
}

std::string_view text_of(const hc::Message& message) {
  return {reinterpret_cast<const char*>(message.elements.data()), message.elements.size()};
}

/// The problem with a message; "" if none.
std::string problem(Control control, const hc::Message& message,
                    const std::set<std::int32_t>& modes) {
  auto is_none = [&](std::int32_t mode) {
    return "mode " + std::to_string(mode) + " is not in the graph";
  };
  const auto& header = message.header;
  switch (control) {
    case Control::Alive:
      return {};
    case Control::Stick:
      if (!is(message, hc::MatrixType::Table, 1, 2)) return "a stick is a table 2 x 1 of 1 x f64";
      if (std::ranges::any_of(numbers_of(message), [](double x) { return std::abs(x) > 1; }))
        return "a stick is from -1 to 1";
      return {};
    case Control::Rotation:
      if (!is(message, hc::MatrixType::Rotation, 3) || header.coord != Coord::kSupervisor)
        return "a head's rotation is a rotation 1 x 1 of 3 x f64 in coordinate system 14";
      return {};
    case Control::Target:
      if (!is(message, hc::MatrixType::Position, 3) ||
          (header.coord != Coord::kLeftImage && header.coord != Coord::kRightImage))
        return "a target is a position 1 x 1 of 3 x f64 in coordinate system 7 or 8";
      return {};
    case Control::Text:
      if (header.info.type != hc::MatrixType::String || !message.plain() ||
          message.elements.size() > kMaxText)
        return "a text is a string of at most 4096 bytes";
      if (header.mode != 0 && !modes.contains(header.mode)) return is_none(header.mode);
      return {};
    case Control::Bid:
      if (!is(message, hc::MatrixType::Table, 1) || header.mode <= 0)
        return "a bid is a table 1 x 1 of 1 x f64 with a mode";
      if (numbers_of(message)[0] < 0 || numbers_of(message)[0] > 1) return "a bid is from 0 to 1";
      if (!modes.contains(header.mode)) return is_none(header.mode);
      return {};
    case Control::Name:
      if (header.info.type != hc::MatrixType::String || !message.plain() || header.height != 1 ||
          !is_track_and_name(text_of(message)))
        return "a name is a string \"TRACK NAME\", the name of at most 64 bytes of UTF-8, without "
               "\"/\" and a dot at the beginning";
      return {};
    case Control::Hold:
      if (!is(message, hc::MatrixType::Table, 1) || !is_track(numbers_of(message)[0]))
        return "a hold is a table 1 x 1 of 1 x f64, a track or 0";
      return {};
  }
  return "unknown src";
}

hc::Message withdrawn(const hc::Message& bid) {
  auto message = static_cast<hc::Message>(hc::table().message({0.0}));
  message.header.mode = bid.header.mode;
  return message;
}

}  // namespace

hc::Result<std::vector<Order>> Driver::take(hc::Message message,
                                            const std::set<std::int32_t>& modes, hc::Time wall,
                                            hc::MonotonicTime now) {
  const auto src = message.header.src;
  const auto control = static_cast<Control>(src);
  const std::string wrong = src < kControls ? problem(control, message, modes) : "unknown src";
  if (!wrong.empty())
    return hc::Error{hc::Code::Malformed, "src " + std::to_string(src) + ": " + wrong};
  heard_ = now;
  if (control == Control::Alive) return std::vector<Order>{};
  std::vector<Order> orders;
  auto& header = message.header;
  if (control == Control::Target && header.time != hc::Time()) {
    if (std::chrono::abs(header.time - wall) > kOldest)
      return hc::Error{hc::Code::Invalid,
                       "the image is not current: its time differs by more than 1 s"};
  } else {
    header.time = wall;
  }
  header.dst = 0;
  if (control != Control::Bid && control != Control::Text) header.mode = 0;
  if (control == Control::Stick)
    is_pushed_ = std::ranges::any_of(numbers_of(message), [](double x) { return x != 0; });
  if (control == Control::Hold) is_holding_ = numbers_of(message)[0] != 0;
  if (control == Control::Bid) {
    // Withdraw the previous task's bid after the new one is sent, so that there is no gap.
    const auto before = std::exchange(
        bid_, numbers_of(message)[0] > 0 ? std::optional(message.keep()) : std::nullopt);
    bid_sent_ = now;
    orders.push_back({control, message.keep()});
    if (before && before->header.mode != header.mode) {
      orders.push_back({Control::Bid, withdrawn(*before)});
      orders.back().message.header.time = wall;
    }
    return orders;
  }
  orders.push_back({control, message.keep()});
  return orders;
}

std::vector<Order> Driver::tick(hc::Time wall, hc::MonotonicTime now) {
  if (now - heard_ > kSilence) return leave(wall);
  if (!bid_ || now - bid_sent_ < kBid) return {};
  bid_sent_ = now;
  bid_->header.time = wall;
  return {{Control::Bid, *bid_}};
}

std::vector<Order> Driver::leave(hc::Time wall) {
  std::vector<Order> orders;
  if (std::exchange(is_pushed_, false))
    orders.push_back({Control::Stick, hc::table().message({0.0, 0.0})});
  if (std::exchange(is_holding_, false))
    orders.push_back({Control::Hold, hc::table().message({0.0})});
  if (bid_) orders.push_back({Control::Bid, withdrawn(*std::exchange(bid_, std::nullopt))});
  for (auto& order : orders) order.message.header.time = wall;
  return orders;
}
