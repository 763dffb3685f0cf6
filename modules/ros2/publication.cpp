// SPDX-License-Identifier: Apache-2.0
#include "publication.h"

#include <utility>

#include <client/graph_client.h>
#include <hc/base/clock.h>
#include <hc/contract/description.h>
#include <ros/type_for.h>

#include "names.h"

namespace {

using hc::ros::Type;

/// The default type for a port, from its module's description.
hc::Result<Type> type_of(const hc::RunningGraph& graph, const std::string& port) {
  const auto dot = port.find('.');
  const auto answer = hc::ask(graph, {"describe " + port.substr(0, dot)});
  if (!answer) return answer.error();
  const hc::Error unknown{hc::Code::Unsupported,
                          "unknown message type; name it: " + port + "=/topic:std_msgs/msg/String"};
  if (!answer->is_ok || answer->rows.empty()) return unknown;
  const auto description = hc::parse_description(answer->rows.front());
  if (!description) return unknown;
  const auto* output = hc::find_named(description->outputs, port.substr(dot + 1));
  const auto known = output != nullptr ? hc::ros::type_for(*output) : std::nullopt;
  if (!known || hash_of(*known).empty()) return unknown;
  return *known;
}

}  // namespace

Qos qos_of(const Mapping& published, Type type) {
  Qos qos;
  qos.reliable = published.reliable.value_or(!is_sensor_data(type));
  if (is_sensor_data(type)) qos.depth = 5;
  if (type == Type::TfMessage) qos.depth = 100;
  return qos;
}

Publication::Publication(hc::RunningGraph graph, Mapping published,
                         std::map<std::int32_t, std::string> frames, Participant& participant,
                         Log log)
    : graph_(graph),
      published_(std::move(published)),
      participant_(participant),
      log_(std::move(log)),
      limit_(published_.rate),
      tap_((encoder_.frames = std::move(frames), encoder_.joints = published_.choice.joints,
            std::move(graph)),
           published_.port,
           {.open = [this] { open(); },
            .message = [this](const hc::Message& message) { take(message); },
            .end =
                [this](const std::string& why, bool is_error) {
                  if (is_error) log_(published_.port, published_.port + ": " + why);
                }}) {}

void Publication::open() {
  auto type =
      published_.type ? hc::Result<Type>(*published_.type) : type_of(graph_, published_.port);
  if (!type) return log_(published_.port, published_.port + ": " + type.error().detail);
  type_ = *type;
  auto writer = participant_.write(published_.topic, type_, qos_of(published_, type_));
  if (!writer) return log_(published_.port, writer.error().detail);
  writer_ = std::move(*writer);
}

void Publication::take(const hc::Message& message) {
  if (!writer_ || !limit_.passes(hc::SystemClock().monotonic())) return;
  const auto pieces = encoder_.encode_any(type_, message);
  if (!pieces)
    return log_("not published as " + published_.topic,
                published_.port + ": " + pieces.error().detail);
  if (auto written = writer_->write(*pieces); !written)
    log_("not written to " + published_.topic, published_.topic + ": " + written.error().detail);
}
