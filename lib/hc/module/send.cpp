// SPDX-License-Identifier: Apache-2.0
// How messages leave a module.
#include <chrono>
#include <optional>
#include <utility>

#include <hc/compress/compress.h>
#include <hc/compress/convert.h>
#include <hc/module/loop.h>
#include <hc/module/outlets.h>

namespace hc {
namespace {

using internal::Outlet;

constexpr std::size_t kHeaderBytes = 80;  // about

/// The message as a link is to send it; nullopt: the link is spared this one.
std::optional<Message> made_for(Outlet& outlet, const Message& message) {
  const auto now = std::chrono::steady_clock::now();
  if (outlet.idle && !outlet.idle->lets_pass(message, now)) return {};
  if (!outlet.adapted || !can_scale(message.header.info))
    return value_or_end(convert(message, outlet.conversion));
  auto& adaptation = outlet.adapted->adaptation;
  const auto form = adaptation.choose(message.header.time, now, outlet.adapted->is_behind());
  if (!form) return {};
  auto conversion = outlet.conversion;
  conversion.as = conversion.as.value_or(Encoding::Jpeg);
  conversion.quality = form->quality;
  conversion.scale = form->scale;
  auto made = value_or_end(convert(message, conversion));
  adaptation.note_size(made.elements.size() + kHeaderBytes);
  return made;
}

Status send_converted(Outlet& outlet, const Message& message) {
  const auto made = made_for(outlet, message);
  if (made) return outlet.sink->send(*made);
  ++outlet.thinned;
  return {};
}

/// Sends by an outlet; false if its reader has left, which ends the outlet.
bool send_to(Outlet& outlet, const std::string& port, const Message& message) {
  const bool is_plain = outlet.conversion.is_none() && !outlet.adapted && !outlet.idle;
  auto sent = is_plain ? outlet.sink->send(message) : send_converted(outlet, message);
  if (sent) return true;
  const auto& error = sent.error();
  if (error.code != Code::Closed)
    internal::fail(error.code == Code::NotFound ? outlet.uri : port, error);
  outlet.end();
  return false;
}

/// Calls `send_one` with each outlet of an output. Commands may add and remove outlets meanwhile;
/// an added one is spared the message, which a removed one to the same reader may have taken.
/// @returns  whether a reader has left.
template <typename SendOne>
bool send_to_each(internal::OutputState& output, const SendOne& send_one) {
  bool any_ended = false;
  const auto seq = output.seq++;
  for (std::size_t i = 0; i < output.links.size();) {
    auto* outlet = output.links[i].get();
    const bool takes = outlet->sink != nullptr && outlet->first <= seq;
    const bool ended = takes && !send_one(*outlet);
    if (i >= output.links.size() || output.links[i].get() != outlet) continue;  // it was removed
    any_ended = any_ended || ended;
    ++i;
  }
  return any_ended;
}

}  // namespace

void internal::Trace::flush() {
  flushed_ = clock_.monotonic();
  if (lost_ > 0) events_.push_back({TraceEvent::What::Lost, "", 0, lost_, Time(), clock_.wall()});
  lost_ = 0;
  if (events_.empty()) return;
  Message message = make_trace(events_);
  message.header.seq = output.seq;
  message.header.time = events_.front().moment;
  events_.clear();
  send_to_each(output, [&](Outlet& outlet) {
    const bool is_sent = outlet.sink->send(message).has_value();
    if (!is_sent) outlet.end();
    return is_sent;
  });
}

void internal::send(OutputState& output, Message&& message) {
  Module& module = *output.module;
  Header& header = message.header;
  header.src = output.address;
  header.seq = output.seq;
  if (header.dst == 0) header.dst = output.to;
  if (header.mode == 0) header.mode = module.focus_.mode_of(module.handled_.mode);
  if (header.coord == 0) header.coord = output.type().coord;
  if (header.coord == 0) header.coord = module.handled_.coord_for(header.info.type);
  if (header.time == Time()) header.time = module.handled_.time;
  auto wanted = output.encoding.value_or(output.type().info.encoding);
  if (message.plain() && (wanted == Encoding::Text || wanted == Encoding::Binary))
    header.info.encoding = wanted;  // the same in memory
  else
    message = value_or_end(compress(message, wanted));
  if (module.loop_ != nullptr) module.loop_->note(TraceEvent::What::Sent, output.name, header);
  const bool any_ended = send_to_each(output, [&](Outlet& outlet) {
    return !outlet.route.takes(header.dst) || send_to(outlet, output.name, message);
  });
  if (any_ended && !module.is_read()) throw Stopped();
}

std::size_t internal::forward(OutputState& output, const Message& message) {
  Module& module = *output.module;
  const std::string* from = module.handled_.peer;
  std::size_t taken = 0;
  if (module.loop_ != nullptr)
    module.loop_->note(TraceEvent::What::Sent, output.name, message.header);
  const bool any_ended = send_to_each(output, [&](Outlet& outlet) {
    if (!outlet.route.takes(message.header.dst)) return true;
    if (from != nullptr && !from->empty() && *from == outlet.route.peer) return true;
    if (!send_to(outlet, output.name, message)) return false;
    ++taken;
    return true;
  });
  if (any_ended && !module.is_read()) throw Stopped();
  return taken;
}

}  // namespace hc
