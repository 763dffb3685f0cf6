// SPDX-License-Identifier: Apache-2.0
#include "bridge.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <hc/module/module.h>
#include <hc/os/secret.h>

namespace web = hc::web;

namespace {

constexpr const char* kProtocols[] = {"foxglove.sdk.v1", "foxglove.websocket.v1"};  // best first
constexpr std::int32_t kFailed = 2;  // status level of an error

using web::refusal;

/// The best supported protocol in a comma-separated offer; null if none.
const char* chosen(std::string_view offered) {
  std::string list = "," + std::string(offered) + ",";
  std::erase(list, ' ');
  for (const char* ours : kProtocols)
    if (list.find("," + std::string(ours) + ",") != std::string::npos) return ours;
  return nullptr;
}

/// The list of a key; empty if missing.
const Json& list_of(const Json& object, const char* key) {
  static const Json kNone = Json::array();
  const auto found = object.find(key);
  return found != object.end() && found->is_array() ? *found : kNone;
}

std::vector<std::string> strings_of(const Json& object, const char* key) {
  std::vector<std::string> strings;
  for (const Json& each : list_of(object, key))
    if (each.is_string()) strings.push_back(each.get<std::string>());
  return strings;
}

/// The number of a key, if it is an unsigned 32-bit integer.
std::optional<std::uint32_t> number_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number_unsigned() ||
      found->get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max())
    return std::nullopt;
  return found->get<std::uint32_t>();
}

/// A parameter value as text.
std::string text_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  // JavaScript has no integers: write whole numbers without a fraction.
  if (value.is_number_float() && value.get<double>() == std::floor(value.get<double>()) &&
      std::abs(value.get<double>()) < 1e15)
    return std::to_string(value.get<std::int64_t>());
  return value.dump();
}

}  // namespace

Bridge::Bridge(Options options, web::Access& access, web::Server& server)
    : options_(std::move(options)),
      access_(access),
      server_(server),
      session_(hc::make_secret()),
      catalog_(options_.jpeg),
      graph_(server.loop(), options_.graph) {
  for (const auto& joint : options_.joints.fixed) joints_[joint.child] = joint;
  constexpr std::chrono::milliseconds kTick{100};
  server_.every(kTick, [this] { tick(); });
  const auto watched = graph_.watch(
      {[this](const auto& state, std::string_view) { apply(catalog_.take_state(state)); },
       [this](const auto& line, auto) { take_log(line); }, [this] { close(); }});
  if (!watched) throw hc::ModuleError(watched.error());
}

web::Reply Bridge::reply(const web::Request& request) {
  if (!access_.is_host(request.host))
    return refusal(421, "this server is not \"" + request.host.substr(0, 64) +
                            "\"; open the URL that it printed");
  if (!request.is_socket)
    return refusal(426, "this server is for Foxglove and Lichtblick: open its ws:// URL there");
  if (request.path != "/") return refusal(404, "no such socket; the path is /");
  if (!access_.right_of_session(web::option(request.query, "token")))
    return refusal(401, "the URL needs the token that was printed when the graph started");
  const char* protocol = chosen(request.protocols);
  if (protocol == nullptr)
    return refusal(400,
                   "no protocol in common: this server speaks foxglove.sdk.v1 and "
                   "foxglove.websocket.v1");
  web::Reply reply;
  reply.status = 101;
  reply.fields = {{"Sec-WebSocket-Protocol", protocol}};
  return reply;
}

void Bridge::open(std::shared_ptr<web::WebSocket> socket, const web::Request& request) {
  const auto right = access_.right_of_session(web::option(request.query, "token"));
  auto& events = *socket;
  auto viewer = std::make_shared<Viewer>(std::move(socket), right.value_or(web::Right::View));
  viewers_.push_back(viewer);
  events.on_text = [this, weak = std::weak_ptr(viewer)](std::string_view line) {
    if (const auto still = weak.lock()) take_text(still, line);
  };
  events.on_binary = [weak = std::weak_ptr(viewer)](std::string_view) {
    if (const auto still = weak.lock())
      still->say_status(kFailed,
                        "binary messages are not supported: this server accepts no publications");
  };
  events.on_close = [this, viewer = viewer.get()] { remove(viewer); };
  viewer->say(Json{
      {"op", "serverInfo"},
      {"name", "Hypercolumn: " + options_.graph.name},
      {"capabilities", {"parameters", "parametersSubscribe", "connectionGraph", "time"}},
      {"supportedEncodings", Json::array()},
      {"metadata", {{"graph", options_.graph.text()}}},
      {"sessionId",
       session_}}.dump());
  std::vector<Channel> channels;
  for (const auto& [id, channel] : catalog_.channels()) channels.push_back(channel);
  viewer->say(Catalog::advertise(channels));
}

void Bridge::take_text(const std::shared_ptr<Viewer>& who, std::string_view line) {
  Viewer& viewer = *who;
  const Json request = Json::parse(line, nullptr, false);
  if (!request.is_object()) return viewer.say_status(kFailed, "not a JSON object");
  const std::string op = string_of(request, "op");
  if (op == "subscribe") {
    subscribe(viewer, request);
  } else if (op == "unsubscribe") {
    unsubscribe(viewer, request);
  } else if (op == "getParameters") {
    get_parameters(viewer, request);
  } else if (op == "setParameters") {
    set_parameters(who, request);
  } else if (op == "subscribeParameterUpdates" || op == "unsubscribeParameterUpdates") {
    const auto names = strings_of(request, "parameterNames");
    const bool is_wanted = op.starts_with("s");
    if (names.empty()) {
      viewer.all_parameters = is_wanted;
      if (!is_wanted) viewer.parameters.clear();
    }
    for (const auto& name : names) {
      if (!is_wanted) viewer.parameters.erase(name);
      if (is_wanted && catalog_.has_parameter(name)) viewer.parameters.insert(name);
    }
  } else if (op == "subscribeConnectionGraph" || op == "unsubscribeConnectionGraph") {
    viewer.graph = op.starts_with("s");
    if (viewer.graph) viewer.say(catalog_.connection_graph());
  } else {
    viewer.say_status(kFailed, excerpt(Json(op)) + " is not supported");
  }
}

void Bridge::subscribe(Viewer& viewer, const Json& request) {
  for (const Json& each : list_of(request, "subscriptions")) {
    const auto id = number_of(each, "id"), channel = number_of(each, "channelId");
    const auto found = catalog_.channels().find(channel.value_or(0));
    if (!id || found == catalog_.channels().end()) {
      viewer.say_status(kFailed, "no such channel: " + excerpt(each));
      continue;
    }
    if (!viewer.subscribe(*id, found->second)) {
      viewer.say_status(kFailed, "already subscribed, or too many subscriptions: " + excerpt(each));
      continue;
    }
    if (found->second == catalog_.frames()) publish_frames();
    if (found->second.port.empty() || publishers_.contains(*channel)) continue;
    publishers_[*channel] = std::make_unique<Publisher>(
        options_.graph, found->second, options_.joints.names,
        [this](std::function<void()> call) { server_.post(std::move(call)); },
        Publisher::Callbacks{
            [this, channel = *channel](const Payload& payload) { publish(channel, payload); },
            [this, topic = found->second.topic](const std::string& why) {
              for (const auto& other : viewers_)
                other->say_status(kFailed, topic + ": " + why, "topic:" + topic);
            }});
  }
}

void Bridge::unsubscribe(Viewer& viewer, const Json& request) {
  for (const Json& each : list_of(request, "subscriptionIds"))
    if (each.is_number_unsigned())
      viewer.unsubscribe(static_cast<std::uint32_t>(
          std::min<std::uint64_t>(each.get<std::uint64_t>(), UINT32_MAX)));
}

void Bridge::get_parameters(Viewer& viewer, const Json& request) {
  auto names = strings_of(request, "parameterNames");
  if (names.empty()) names = catalog_.parameter_names();
  viewer.say(catalog_.parameter_values(names, string_of(request, "id")));
}

void Bridge::set_parameters(const std::shared_ptr<Viewer>& viewer, const Json& request) {
  if (viewer->right() < web::Right::Operate)
    return viewer->say_status(kFailed,
                              "this URL is view only; changing parameters needs the right to "
                              "operate");
  std::map<std::string, std::string> values;
  for (const Json& each : list_of(request, "parameters")) {
    const std::string name = string_of(each, "name");
    if (!catalog_.has_parameter(name) || !each.contains("value")) {
      viewer->say_status(kFailed, "no such parameter: " + excerpt(each));
      continue;
    }
    std::string value = text_of(each["value"]);
    if (value.find('\n') == std::string::npos)
      values[name] = std::move(value);
    else
      viewer->say_status(kFailed, name + ": a value must be a single line");
  }
  // Answered when all are done; values that could not be set are then reported unchanged.
  struct Answer {
    std::vector<std::string> names;
    std::map<std::string, std::string> set;
    std::size_t open = 0;
  };
  auto answer = std::make_shared<Answer>();
  answer->open = values.size();
  auto reply = [this, answer, weak = std::weak_ptr(viewer), id = string_of(request, "id")] {
    const auto still = weak.lock();
    if (still && !id.empty()) still->say(catalog_.parameter_values(answer->names, id, answer->set));
  };
  if (values.empty()) return reply();
  for (const auto& [name, value] : values) {
    answer->names.push_back(name);
    graph_.command({"set " + name + "=" + value}, [answer, reply, weak = std::weak_ptr(viewer),
                                                   name = name, value = value](
                                                      const hc::Result<hc::GraphAnswer>& answered) {
      const bool is_set = answered && answered->is_ok;
      if (is_set) answer->set[name] = value;
      if (const auto still = weak.lock(); still && !is_set)
        still->say_status(kFailed, answered ? answered->rows.front() : answered.error().detail);
      if (--answer->open == 0) reply();
    });
  }
}

void Bridge::take_log(const hc::LogLine& line) {
  const hc::Time time = clock_.wall();
  publish(catalog_.log().id, {time, bytes_of(encoder_.encode_log(time, line))});
}

void Bridge::apply(const Catalog::Changes& changes) {
  for (const auto& module : changes.unknown)
    graph_.command({"describe " + module},
                   [this, module](const hc::Result<hc::GraphAnswer>& answer) {
                     if (answer && answer->is_ok && !answer->rows.empty())
                       apply(catalog_.describe(module, answer->rows.front()));
                   });
  for (const auto& channel : changes.removed) publishers_.erase(channel.id);
  for (const auto& viewer : viewers_) {
    for (const auto& channel : changes.removed) viewer->forget(channel.id);
    if (!changes.removed.empty()) viewer->say(Catalog::unadvertise(changes.removed));
    if (!changes.added.empty()) viewer->say(Catalog::advertise(changes.added));
    if (changes.graph && viewer->graph) viewer->say(catalog_.connection_graph());
    std::vector<std::string> wanted;
    for (const auto& name : changes.parameters)
      if (viewer->all_parameters || viewer->parameters.contains(name)) wanted.push_back(name);
    if (!wanted.empty()) viewer->say(catalog_.parameter_values(wanted, {}));
  }
}

void Bridge::publish(std::uint32_t channel, const Payload& payload) {
  for (const auto& viewer : viewers_) viewer->offer(channel, payload);
}

hc::Status Bridge::move(const hc::Message& pose) {
  const auto joint = options_.joints.joint_of(pose);
  if (!joint) return joint.error();
  server_.post([this, kept = *joint] { move(kept); });
  return {};
}

void Bridge::move(const hc::ros::Joint& joint) {
  joints_[joint.child] = joint;
  if (is_subscribed(catalog_.frames().id))
    publish(catalog_.frames().id, {joint.time, bytes_of(encoder_.encode(std::span(&joint, 1)))});
}

void Bridge::publish_frames() {
  if (joints_.empty() || !is_subscribed(catalog_.frames().id)) return;
  std::vector<hc::ros::Joint> all;
  for (const auto& [child, joint] : joints_) all.push_back(joint);
  publish(catalog_.frames().id, {clock_.wall(), bytes_of(encoder_.encode(all))});
}

bool Bridge::is_subscribed(std::uint32_t channel) const {
  return std::ranges::any_of(viewers_,
                             [&](const auto& viewer) { return viewer->is_subscribed(channel); });
}

void Bridge::remove(const Viewer* viewer) {
  std::erase_if(viewers_, [&](const auto& each) { return each.get() == viewer; });
}

void Bridge::tick() {
  std::erase_if(viewers_, [](const auto& viewer) { return viewer->is_lost(); });
  const hc::Time now = clock_.wall();
  const bool reports = now >= reported_ + std::chrono::seconds(1) || now < reported_;
  if (reports) reported_ = now;
  for (const auto& viewer : viewers_) viewer->say_time(now);
  std::erase_if(publishers_, [&](const auto& each) { return !is_subscribed(each.first); });
  if (!reports) return;
  publish_frames();
  for (const auto& [channel, publisher] : publishers_)
    for (const auto dropped = publisher->take_dropped(); const auto& viewer : viewers_)
      viewer->count_dropped(channel, dropped);
  for (const auto& viewer : viewers_) viewer->report_dropped();
}

void Bridge::close() {
  viewers_.clear();
  publishers_.clear();
}
