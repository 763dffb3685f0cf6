// SPDX-License-Identifier: Apache-2.0
#include "mapping.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <utility>

#include <hc/base/text.h>
#include <hc/base/words.h>

#include "names.h"

namespace {

using hc::ros::Type;

constexpr const char* kSpace = " \t\n";

hc::Error wrong(std::string_view what, const std::string& why) {
  return {hc::Code::Invalid, "\"" + std::string(what) + "\" " + why};
}

/// Splits at the first `=`; without one the second part is empty.
std::pair<std::string_view, std::string_view> pair_of(std::string_view word) {
  const auto at = std::min(word.find('='), word.size());
  return {word.substr(0, at), word.substr(std::min(at + 1, word.size()))};
}

/// Reads "/topic[:TYPE]".
hc::Status read_topic(std::string_view text, Mapping& each) {
  const auto colon = std::min(text.find(':'), text.size());
  each.topic = text.substr(0, colon);
  if (!is_topic(each.topic))
    return wrong(each.topic, "is not a topic name: / followed by letters, digits, _ and /");
  if (colon == text.size()) return {};
  const auto name = text.substr(colon + 1);
  each.type = hc::ros::type_of(name);
  if (!each.type || hash_of(*each.type).empty()) {
    std::string known;
    for (const auto& schema : hc::ros::schemas())
      if (!hash_of(schema.type).empty()) known += (known.empty() ? "" : ", ") + schema.name;
    return wrong(name, "is not a supported type: " + known);
  }
  return {};
}

/// Reads the options after an entry's first word. @param is_subscribed  also allows coord=, child=.
hc::Status read_options(std::span<const std::string_view> words, bool is_subscribed,
                        Mapping& each) {
  for (const auto word : words) {
    const auto [key, value] = pair_of(word);
    if (key == "rate") {
      if (!hc::read_number(value, each.rate) || !(each.rate > 0) || !std::isfinite(each.rate))
        return wrong(word, "is not a rate > 0 [Hz]");
    } else if (key == "qos") {
      if (value != "reliable" && value != "best_effort")
        return wrong(word, "is neither qos=reliable nor qos=best_effort");
      each.reliable = value == "reliable";
    } else if (key == "joints") {
      for (const auto joint : hc::words_of(value, "+")) each.choice.joints.emplace_back(joint);
    } else if (key == "coord" && is_subscribed) {
      if (!hc::read_number(value, each.coord) || each.coord < 0)
        return wrong(word, "is not a coord");
    } else if (key == "child" && is_subscribed) {
      each.choice.child = value;
    } else {
      return wrong(word, is_subscribed ? "is not one of rate=, qos=, coord=, child=, joints="
                                       : "is not one of rate=, qos=, joints=");
    }
  }
  return {};
}

hc::Result<Mapping> parse_published(std::string_view entry) {
  const auto words = hc::words_of(entry);
  const auto [port, topic] = pair_of(words.front());
  Mapping each;
  each.port = port;
  if (each.port.empty() || topic.empty())
    return wrong(entry, "is not MODULE.PORT=/topic:TYPE, nor frames=/tf");
  if (auto good = read_topic(topic, each); !good) return good.error();
  const bool is_frames = each.port == "frames";
  if (!is_frames && each.port.find('.') == std::string::npos)
    return wrong(each.port, "is neither an output MODULE.PORT nor frames");
  if (is_frames && each.type && *each.type != Type::TfMessage)
    return wrong(entry, "needs the type tf2_msgs/msg/TFMessage");
  if (is_frames) each.type = Type::TfMessage;
  if (!is_frames && each.type == Type::TfMessage)
    return wrong(entry, "has a type reserved for frames: frames=/tf");
  if (auto good = read_options(std::span(words).subspan(1), false, each); !good)
    return good.error();
  if (!each.choice.joints.empty() && !each.type) each.type = Type::JointState;
  return each;
}

hc::Result<Mapping> parse_subscribed(std::string_view entry) {
  const auto words = hc::words_of(entry);
  const auto [topic, output] = pair_of(words.front());
  const auto source = std::ranges::find(sources(), output, &Source::output);
  if (source == sources().end()) {
    std::string known;
    for (const auto& other : sources())
      known += (known.empty() ? "" : ", ") + std::string(other.output);
    return wrong(entry, "is not /topic:TYPE=OUTPUT, where OUTPUT is one of " + known);
  }
  Mapping each;
  each.port = output;
  if (auto good = read_topic(topic, each); !good) return good.error();
  if (!each.type) each.type = source->types.front();
  if (std::ranges::count(source->types, *each.type) == 0)
    return wrong(entry, "does not fit: " + hc::ros::schema(*each.type).name +
                            " does not convert to " + each.port);
  if (auto good = read_options(std::span(words).subspan(1), true, each); !good) return good.error();
  if ((each.type == Type::TfMessage) == each.choice.child.empty())
    return wrong(entry, "needs child=FRAME if and only if its type is tf2_msgs/msg/TFMessage");
  return each;
}

/// @param once  the member that must be unique.
hc::Result<std::vector<Mapping>> parse(std::string_view text,
                                       hc::Result<Mapping> (*parse_entry)(std::string_view),
                                       std::string Mapping::*once) {
  constexpr std::size_t kMost = 100;
  std::vector<Mapping> all;
  std::set<std::string> seen;
  for (const auto entry : hc::words_of(text, ",")) {
    if (entry.find_first_not_of(kSpace) == std::string_view::npos) continue;
    auto each = parse_entry(entry);
    if (!each) return each.error();
    if (!each->choice.joints.empty() && each->type != Type::JointState)
      return wrong(entry, "may have joints= only with the type sensor_msgs/msg/JointState");
    if (!seen.insert((*each).*once).second) return wrong((*each).*once, "is repeated");
    all.push_back(std::move(*each));
  }
  if (all.size() > kMost)
    return hc::Error{hc::Code::Invalid, "more than 100 topics; run another ros2 for the others"};
  return all;
}

}  // namespace

const std::vector<Source>& sources() {
  static const std::vector<Source> kSources = {{"image", {Type::Image, Type::CompressedImage}},
                                               {"grey", {Type::Image, Type::CompressedImage}},
                                               {"depth", {Type::Image}},
                                               {"points", {Type::PointCloud2}},
                                               {"camera", {Type::CameraInfo}},
                                               {"pose", {Type::PoseStamped, Type::TfMessage}},
                                               {"twist", {Type::Twist}},
                                               {"joints", {Type::JointState}},
                                               {"text", {Type::String}},
                                               {"numbers", {Type::Float64MultiArray}}};
  return kSources;
}

bool is_sensor_data(Type type) {
  return type == Type::Image || type == Type::CompressedImage || type == Type::PointCloud2 ||
         type == Type::CameraInfo || type == Type::JointState;
}

hc::Result<std::vector<Mapping>> parse_publish(std::string_view text) {
  return parse(text, parse_published, &Mapping::topic);
}

hc::Result<std::vector<Mapping>> parse_subscribe(std::string_view text) {
  return parse(text, parse_subscribed, &Mapping::port);
}
