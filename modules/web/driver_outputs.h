// SPDX-License-Identifier: Apache-2.0
#pragma once
// The outputs for the driver's commands. A slow reader of them never delays the stop, since
// sending does not wait.

#include <cstdint>

#include <hc/module/module.h>

#include "driver.h"

struct DriverOutputs {
  static constexpr std::uint32_t kTexts = 8;  ///< queue of texts to speak
  static constexpr std::uint32_t kNames = 8;  ///< queue of names to learn
  static constexpr std::uint32_t kBids = 4;   ///< queue of bids: the newest and withdrawals

  hc::Module& module;

  hc::Output<hc::TableKind<double>> stick = module.output(
      "stick", hc::table().of(1, 2), "left > 0, down > 0, each -1 to 1, from the driver",
      {.keep = 1, .columns = {"left", "down"}});
  hc::Output<hc::RotationKind<double>> rotation =
      module.output("rotation", hc::rotation().in(hc::Coord::kSupervisor),
                    "roll, pitch, yaw of the driver's head [rad]", {.keep = 1});
  hc::Output<hc::PositionKind<double>> target =
      module.output("target", hc::position(),
                    "selected point: x, y in the left (7) or right (8) image [px]", {.keep = 1});
  hc::Output<hc::StringKind> text =
      module.output("text", hc::string(), "to speak", {.keep = kTexts});
  hc::Output<hc::TableKind<double>> bid =
      module.output("bid", hc::table(), "for the task chosen by the driver",
                    {.keep = kBids, .columns = {"salience"}});
  hc::Output<hc::StringKind> name = module.output(
      "name", hc::string(), "\"TRACK NAME\": names the person of a track", {.keep = kNames});
  hc::Output<hc::TableKind<double>> hold =
      module.output("hold", hc::table().of(1, 1), "track of the person to look at; 0: of anybody",
                    {.keep = 1, .columns = {"track"}});

  void send(const Order& order) {
    switch (order.control) {
      case Control::Alive:
        return;
      case Control::Stick:
        return stick.send({order.message});
      case Control::Rotation:
        return rotation.send({order.message});
      case Control::Target:
        return target.send({order.message});
      case Control::Text:
        return text.send({order.message});
      case Control::Bid:
        return bid.send({order.message});
      case Control::Name:
        return name.send({order.message});
      case Control::Hold:
        return hold.send({order.message});
    }
  }
  /// A bit for each Control whose output is linked.
  [[nodiscard]] unsigned linked() const {
    const auto bit = [](Control control, const auto& output) {
      return output.linked() ? 1U << static_cast<unsigned>(control) : 0U;
    };
    return bit(Control::Stick, stick) | bit(Control::Rotation, rotation) |
           bit(Control::Target, target) | bit(Control::Text, text) | bit(Control::Bid, bid) |
           bit(Control::Name, name) | bit(Control::Hold, hold);
  }
};
