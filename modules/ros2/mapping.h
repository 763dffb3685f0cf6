// SPDX-License-Identifier: Apache-2.0
#pragma once
// What is published and subscribed, as the parameters say. Pure.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/result.h>
#include <ros/decode.h>
#include <ros/schema.h>

/// An output that ROS gets, "MODULE.PORT=/topic[:TYPE] [rate=HZ] [qos=best_effort] [joints=A+B]",
/// or the frames, "frames=/tf"; or a topic that the graph gets, "/topic[:TYPE]=OUTPUT [rate=HZ]
/// [qos=reliable] [coord=N] [child=FRAME] [joints=A+B]".
struct Mapping {
  std::string port, topic;
  std::optional<hc::ros::Type> type;  ///< none: what the port's messages become
  double rate = 0;                    ///< most messages a second; 0: all [Hz]
  std::optional<bool> reliable;
  hc::ros::Choice choice;  ///< joints: of an output, the names of a table's columns
  std::int32_t coord = 0;  ///< of the messages of a topic
};

/// What an output of this module is made of.
struct Source {
  std::string_view output;
  std::vector<hc::ros::Type> types;  ///< the first one where none is named
};
const std::vector<Source>& sources();

/// Whether readers of a type want the newest rather than each message.
bool is_sensor_data(hc::ros::Type type);

/// Entries with a comma between them; those that are subscribed have a type. Errors: Invalid, in
/// one line.
hc::Result<std::vector<Mapping>> parse_publish(std::string_view text);
hc::Result<std::vector<Mapping>> parse_subscribe(std::string_view text);

/// Lets at most so many a second pass.
class RateLimit {
 public:
  explicit RateLimit(double rate) : period_(rate > 0 ? 1e9 / rate : 0) {}
  /// @param now  of a clock that does not go back. [ns]
  bool passes(std::int64_t now) {
    const auto at = static_cast<double>(now);
    if (period_ > 0 && at < due_) return false;
    // On the grid, so that a source of that rate keeps it though it jitters.
    due_ = at - due_ > period_ ? at + period_ / 2 : due_ + period_;
    return true;
  }

 private:
  double period_, due_ = 0;
};
