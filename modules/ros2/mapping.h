// SPDX-License-Identifier: Apache-2.0
#pragma once
// Parses the parameters `publish` and `subscribe`. Pure.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/result.h>
#include <ros/decode.h>
#include <ros/schema.h>

/// An output published to ROS, "MODULE.PORT=/topic[:TYPE] [rate=HZ] [qos=best_effort]
/// [joints=A+B]", or the frames, "frames=/tf"; or a subscribed topic, "/topic[:TYPE]=OUTPUT
/// [rate=HZ] [qos=reliable] [coord=N] [child=FRAME] [joints=A+B]".
struct Mapping {
  std::string port, topic;
  std::optional<hc::ros::Type> type;  ///< none: the default for the port
  double rate = 0;                    ///< maximum; 0: unlimited [Hz]
  std::optional<bool> reliable;
  hc::ros::Choice choice;  ///< `joints` of an output: names of the table's columns
  std::int32_t coord = 0;  ///< of messages from a topic
};

/// The ROS types that an output of this module can be converted from.
struct Source {
  std::string_view output;
  std::vector<hc::ros::Type> types;  ///< the default first
};
const std::vector<Source>& sources();

/// Whether subscribers of a type want the newest message rather than all.
bool is_sensor_data(hc::ros::Type type);

/// Parse comma-separated entries; subscribed ones always have a type. Errors: Invalid.
hc::Result<std::vector<Mapping>> parse_publish(std::string_view text);
hc::Result<std::vector<Mapping>> parse_subscribe(std::string_view text);

/// Limits a rate [Hz].
class RateLimit {
 public:
  explicit RateLimit(double rate) : period_(rate > 0 ? 1 / rate : 0) {}
  bool passes(hc::MonotonicTime now) {
    const double at = hc::seconds(now);
    if (period_ > 0 && at < due_) return false;
    // On a fixed grid, so that a jittering source of exactly this rate passes unthinned.
    due_ = at - due_ > period_ ? at + period_ / 2 : due_ + period_;
    return true;
  }

 private:
  double period_, due_ = 0;  // [s]
};
