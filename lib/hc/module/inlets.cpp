// SPDX-License-Identifier: Apache-2.0
#include <hc/module/inlets.h>

#include <algorithm>
#include <set>
#include <utility>

#include <hc/module/ending.h>
#include <hc/module/management.h>

namespace hc {
namespace {

using internal::Inlet;

constexpr const char* kSetsKept = "4";  // by links whose newest complete set is handled
constexpr int kMostAtOnce = 16;         // messages of such a link in a turn

/// Whether a link has keep=latest; gives it a short queue instead.
bool replace_latest(Uri& uri) {
  for (auto& [key, value] : uri.options)
    if (key == "keep" && (value == "latest" || value == "1")) {
      value = kSetsKept;
      return true;
    }
  return false;
}

bool is_crowded(const Inlet& inlet) {
  return std::ranges::any_of(inlet.inputs, [](const auto* input) {
    return input->together != nullptr && input->together->matcher.crowded(input->place);
  });
}

}  // namespace

void Module::Inlets::open(const internal::Arguments& arguments) {
  for (const auto& link : arguments.inputs) open(link);
  if (arguments.control || module_.inputs_.empty() ||
      !std::ranges::all_of(arguments.inputs, &internal::PortLink::is_focus))
    return;
  std::vector<internal::InputState*> all;
  for (auto& input : module_.inputs_) all.push_back(input.get());
  open({"-", "", {}}, std::move(all));
}

void Module::Inlets::open(const internal::PortLink& link) {
  if (!link.is_focus) return open(link.uri, {module_.inputs_[link.port].get()});
  std::erase_if(focus_, [&](const auto& each) { return each.uri == link.uri.text(); });
  focus_.push_back(
      {.uri = link.uri.text(), .source = opener_.open(link.uri, internal::kFocusPort)});
  module_.focus_.is_linked = true;
}

void Module::Inlets::open(const Uri& uri, std::vector<internal::InputState*> inputs) {
  // Synchronised inputs drop whole sets, so their links must not drop messages.
  Uri opened = uri;
  const bool is_latest = inputs.front()->together != nullptr && replace_latest(opened);
  Inlet inlet{.uri = uri.text(), .source = opener_.open(opened, inputs.front()->name)};
  inlet.inputs = std::move(inputs);
  inlet.is_latest = is_latest;
  std::set<std::int32_t> numbers;
  for (const auto& each : inlets_) {
    if (each.is_same(inlet)) inlet.route = each.route;
    if (each.inputs == inlet.inputs) numbers.insert(each.number);
  }
  while (numbers.contains(inlet.number)) ++inlet.number;  // a link that is changed keeps its own
  inlet.count(1);
  inlets_.push_back(std::move(inlet));
  sets_.begin(inlets_.back());
  join_renewed();
}

bool Module::Inlets::remove(const internal::PortLink& link) {
  return std::erase_if(link.is_focus ? focus_ : inlets_, [&](const Inlet& each) {
           const bool is_it =
               each.uri == link.uri.text() &&
               (link.is_focus || each.inputs.front() == module_.inputs_[link.port].get());
           if (is_it && each.source != nullptr) each.count(-1);
           return is_it;
         }) > 0;
}

void Module::Inlets::finish(const internal::PortLink& link) {
  for (auto& each : link.is_focus ? focus_ : inlets_)
    if (each.uri == link.uri.text() && each.source != nullptr) each.source->finish();
}

void Module::Inlets::set_route(const std::string& link, const internal::Route& route) {
  for (auto& inlet : inlets_)
    for (const auto* input : inlet.inputs)
      if (input->name + "=" + inlet.uri == link) inlet.route = route;
}

bool Module::Inlets::join_renewed() {
  bool any = false;
  for (auto inlet = inlets_.begin(); inlet != inlets_.end();) {
    const auto renewed = inlet->source != nullptr
                             ? inlets_.end()
                             : std::find_if(inlet + 1, inlets_.end(),
                                            [&](const auto& each) { return each.is_same(*inlet); });
    if (renewed == inlets_.end()) {
      ++inlet;
      continue;
    }
    renewed->past += inlet->past;
    renewed->ignored += inlet->ignored;
    renewed->bad += inlet->bad;
    renewed->number = inlet->number;
    inlet = inlets_.erase(inlet);
    any = true;
  }
  return any;
}

void Module::Inlets::end_unneeded() {
  if (module_.together_.empty()) return;
  for (auto& inlet : inlets_)
    if (inlet.source != nullptr && Sets::are_over(inlet)) end(inlet);
}

void Module::Inlets::end(Inlet& inlet) {
  inlet.past += inlet.source->traffic();
  inlet.source.reset();
  inlet.head.reset();
  inlet.count(-1);
  sets_.end(inlet);
}

bool Module::Inlets::all_ended() const {
  if (inlets_.empty() &&
      (opener_.is_in_graph() || (module_.inputs_.empty() && !module_.timers_.empty())))
    return false;
  return std::ranges::all_of(inlets_, [](const Inlet& inlet) { return inlet.source == nullptr; });
}

bool Module::Inlets::have_ended(const internal::InputState& input) const {
  bool any = false;
  for (const auto& inlet : inlets_)
    if (std::ranges::count(inlet.inputs, &input) != 0) {
      if (inlet.source != nullptr) return false;
      any = true;
    }
  return any;
}

Got Module::Inlets::take(Inlet& inlet, Message& message) {
  auto got = inlet.source->take(message);
  if (!got && inlet.inputs.empty()) got = Got::End;  // the focus expires
  if (!got) {
    const auto code = got.error().code;
    const bool is_of_link = code == Code::NotFound || code == Code::Closed;
    internal::fail(is_of_link || inlet.inputs.size() > 1 ? opener_.name_of(inlet.uri, inlet.port())
                                                         : inlet.port(),
                   got.error());
  }
  if (*got == Got::End) end(inlet);
  return *got;
}

bool Module::Inlets::take_one(Inlet& inlet) {
  Message message;
  if (take(inlet, message) != Got::Message) return false;
  const auto taken = now_.machine;
  const auto sensed = message.header.time;  // a handler may move the message away
  delivery_.handle(inlet, message);
  // Afterwards, so that the module's own messages do not wait for it.
  if (module_.management_->is_heard()) inlet.measure(sensed, taken, now_.wall_offset);
  return true;
}

bool Module::Inlets::take_each() {
  bool any = false;
  for (bool crowded : {false, true}) {
    for (auto& inlet : inlets_) {
      // To find the newest set, all messages that have arrived are taken.
      const int most = inlet.together() != nullptr && inlet.together()->is_latest ? kMostAtOnce : 1;
      for (int i = 0; i < most; ++i) {
        if (module_.is_done_ || !inlet.is_open() || is_crowded(inlet) != crowded) break;
        if (any) now_.read();  // handling the messages before took time
        if (!take_one(inlet)) break;
        any = true;
      }
    }
    if (any) break;
  }
  sets_.handle_newest();
  return any;
}

void Module::Inlets::receive_focus() {
  Message message;
  for (auto& inlet : focus_)
    while (inlet.source != nullptr && take(inlet, message) == Got::Message)
      delivery_.handle(inlet, message);
  delivery_.expire_focus();
}

void Module::Inlets::add_counters(std::vector<LinkCounters>& rows) {
  for (auto& inlet : inlets_) rows.push_back(inlet.take_counters());
}

void Module::Inlets::add_ends(std::vector<LinkEnd>& rows) const {
  for (const auto& inlet : inlets_)
    rows.push_back({true, inlet.inputs.size() == 1 ? inlet.port() : "-", inlet.uri});
}

}  // namespace hc
