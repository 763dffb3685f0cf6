// SPDX-License-Identifier: Apache-2.0
#include "mapping.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <utility>

#include "names.h"

namespace {

using hc::ros::Type;

constexpr const char* kSpace = " \t\n";

hc::Error wrong(std::string_view what, const std::string& why) {
  return {hc::Code::Invalid, "\"" + std::string(what) + "\" " + why};
}

/// What is between characters of `at`, and not empty.
std::vector<std::string_view> split(std::string_view text, std::string_view at) {
  std::vector<std::string_view> parts;
  while (true) {
    const auto end = text.find_first_of(at);
    if (const auto part = text.substr(0, end); !part.empty()) parts.push_back(part);
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

/// At the first `=`; the second part is empty where there is none.
std::pair<std::string_view, std::string_view> pair_of(std::string_view word) {
  const auto at = std::min(word.find('='), word.size());
  return {word.substr(0, at), word.substr(std::min(at + 1, word.size()))};
}

template <typename T>
bool read(std::string_view text, T& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

/// "/topic:TYPE" in two; the type is none where it is not said.
hc::Status read_topic(std::string_view text, std::string& topic, std::optional<Type>& type) {
  const auto colon = std::min(text.find(':'), text.size());
  topic = text.substr(0, colon);
  if (!is_topic(topic))
    return wrong(topic, "is no topic: it begins with / and has letters, digits, _ and / in it");
  if (colon == text.size()) return {};
  const auto name = text.substr(colon + 1);
  type = hc::ros::type_of(name);
  if (!type || hash_of(*type).empty()) {
    std::string known;
    for (const auto& schema : hc::ros::schemas())
      if (!hash_of(schema.type).empty()) known += (known.empty() ? "" : ", ") + schema.name;
    return wrong(name, "is no type that is known here, which are " + known);
  }
  return {};
}

/// What both directions have. @returns  false: the option is none of these.
hc::Result<bool> read_option(std::string_view word, double& rate, std::optional<bool>& reliable) {
  const auto [key, value] = pair_of(word);
  if (key == "rate") {
    if (!read(value, rate) || !(rate > 0) || !std::isfinite(rate))
      return wrong(word, "is no rate above 0 [Hz]");
    return true;
  }
  if (key == "qos") {
    if (value != "reliable" && value != "best_effort")
      return wrong(word, "is neither qos=reliable nor qos=best_effort");
    reliable = value == "reliable";
    return true;
  }
  return false;
}

/// "joints=A+B"
std::vector<std::string> joints_of(std::string_view word) {
  std::vector<std::string> joints;
  for (const auto joint : split(pair_of(word).second, "+")) joints.emplace_back(joint);
  return joints;
}

hc::Result<Published> parse_published(std::string_view entry) {
  const auto words = split(entry, kSpace);
  const auto [port, topic] = pair_of(words.front());
  Published each;
  each.port = port;
  if (each.port.empty() || topic.empty())
    return wrong(entry, "is not MODULE.PORT=/topic:TYPE, nor frames=/tf");
  if (auto good = read_topic(topic, each.topic, each.type); !good) return good.error();
  const bool is_frames = each.port == "frames";
  if (!is_frames && each.port.find('.') == std::string::npos)
    return wrong(each.port, "is no output: MODULE.PORT; or frames");
  if (is_frames && each.type && *each.type != Type::TfMessage)
    return wrong(entry, "is not of type tf2_msgs/msg/TFMessage, as frames are");
  if (is_frames) each.type = Type::TfMessage;
  if (!is_frames && each.type == Type::TfMessage)
    return wrong(entry, "is of a type that frames alone have: frames=/tf");
  for (std::size_t i = 1; i < words.size(); ++i) {
    auto read = read_option(words[i], each.rate, each.reliable);
    if (!read) return read.error();
    if (*read) continue;
    if (!words[i].starts_with("joints=")) return wrong(words[i], "is none of rate=, qos=, joints=");
    each.joints = joints_of(words[i]);
  }
  if (!each.joints.empty() && each.type.value_or(Type::JointState) != Type::JointState)
    return wrong(entry, "says joints=, as sensor_msgs/msg/JointState alone does");
  if (!each.joints.empty()) each.type = Type::JointState;
  return each;
}

hc::Result<Subscribed> parse_subscribed(std::string_view entry) {
  const auto words = split(entry, kSpace);
  const auto [topic, output] = pair_of(words.front());
  const auto source = std::ranges::find(sources(), output, &Source::output);
  if (source == sources().end()) {
    std::string known;
    for (const auto& other : sources())
      known += (known.empty() ? "" : ", ") + std::string(other.output);
    return wrong(entry, "is not /topic:TYPE=OUTPUT, where OUTPUT is one of " + known);
  }
  Subscribed each;
  each.output = output;
  std::optional<Type> type;
  if (auto good = read_topic(topic, each.topic, type); !good) return good.error();
  each.type = type.value_or(source->types.front());
  if (std::ranges::count(source->types, each.type) == 0)
    return wrong(entry, "does not fit: " + hc::ros::schema(each.type).name + " does not become " +
                            each.output);
  for (std::size_t i = 1; i < words.size(); ++i) {
    auto known = read_option(words[i], each.rate, each.reliable);
    if (!known) return known.error();
    if (*known) continue;
    const auto [key, value] = pair_of(words[i]);
    if (key == "coord") {
      if (!read(value, each.coord) || each.coord < 0) return wrong(words[i], "is no coord");
    } else if (key == "child") {
      each.choice.child = value;
    } else if (key == "joints") {
      each.choice.joints = joints_of(words[i]);
    } else {
      return wrong(words[i], "is none of rate=, qos=, coord=, child=, joints=");
    }
  }
  if ((each.type == Type::TfMessage) == each.choice.child.empty())
    return wrong(entry, "says child=FRAME, or has to, as tf2_msgs/msg/TFMessage alone does");
  if (!each.choice.joints.empty() && each.type != Type::JointState)
    return wrong(entry, "says joints=, as sensor_msgs/msg/JointState alone does");
  return each;
}

template <typename T>
hc::Result<std::vector<T>> parse(std::string_view text,
                                 hc::Result<T> (*parse_entry)(std::string_view),
                                 std::string T::*once) {
  constexpr std::size_t kMost = 100;
  std::vector<T> all;
  std::set<std::string> seen;
  for (const auto entry : split(text, ",")) {
    if (entry.find_first_not_of(kSpace) == std::string_view::npos) continue;
    auto each = parse_entry(entry);
    if (!each) return each.error();
    if (!seen.insert((*each).*once).second) return wrong((*each).*once, "is there twice");
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

hc::Result<std::vector<Published>> parse_publish(std::string_view text) {
  return parse<Published>(text, parse_published, &Published::topic);
}

hc::Result<std::vector<Subscribed>> parse_subscribe(std::string_view text) {
  return parse<Subscribed>(text, parse_subscribed, &Subscribed::output);
}
