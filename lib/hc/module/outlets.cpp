// SPDX-License-Identifier: Apache-2.0
#include <hc/module/outlets.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <hc/compress/compress.h>
#include <hc/module/ending.h>
#include <hc/module/management.h>

namespace hc {
namespace {

using internal::Outlet;

constexpr const char* kTimeoutInGraphs = "5";  // [s]; if the graph does not say (G16)

/// Adds an option that is not given.
void add_option(Uri& uri, const std::string& option, const std::string& value) {
  if (uri.option(option, "").empty()) uri.options.emplace_back(option, value);
}

void set_option(Uri& uri, const std::string& option, const std::string& value) {
  std::erase_if(uri.options, [&](const auto& each) { return each.first == option; });
  uri.options.emplace_back(option, value);
}

/// Whether readers are on this host, and so connect at once unless they hang.
bool is_on_this_host(const Uri& uri) {
  return uri.scheme == "shm" || uri.scheme == "unix-listen" || !uri.option("same_user", "").empty();
}

/// Sets the options of a link in a graph. @param is_late  the graph runs already.
void set_graph_options(Uri& uri, bool is_late) {
  add_option(uri, "timeout", kTimeoutInGraphs);
  if (is_late && uri.option("stay", "") == "1" && uri.option("timeout", "") != "0")
    add_option(uri, "wait", is_on_this_host(uri) ? "1" : kTimeoutInGraphs);
}

/// Sets the options of a link that waits for no reader (Module::never_waits()).
void set_no_waiting(Uri& uri, std::uint32_t keep) {
  if (uri.option("keep", "all") == "all") set_option(uri, "keep", std::to_string(keep));
  Uri unread = uri;
  set_option(unread, "readers", "0");
  if (check_sink(unread)) uri = unread;  // else its transport has no such option
}

}  // namespace

bool internal::AdaptedLinks::is_behind() const {
  return std::ranges::any_of(outlets, [](const auto& each) {
    const auto outlet = each.lock();
    return outlet && outlet->sink && outlet->sink->is_behind();
  });
}

std::shared_ptr<Outlet> Module::Outlets::open(const Uri& uri, const std::string& port,
                                              std::uint32_t keep) {
  Uri opened = uri;
  auto conversion = take_conversion(opened);
  if (!conversion) internal::fail(opener_.name_of(uri.text(), port), conversion.error());
  const auto* commands = module_.management_->commands();
  // In a graph, a full disk ends a recording, not the module.
  if (commands != nullptr && opened.scheme == "file") add_option(opened, "optional", "1");
  // By the messages' clock no message is lost.
  if (commands != nullptr && !module_.message_time_) set_graph_options(opened, is_late_);
  if (keep > 0) set_no_waiting(opened, keep);
  auto outlet = std::make_shared<Outlet>();
  auto options = opener_.options_for(opened, port);
  options.awaits_reader = [this, blocked = outlet.get()](bool awaits) {
    calls_.report_blocked(awaits ? blocked : nullptr);
  };
  if (commands != nullptr) options.interrupt = {commands->descriptor(), calls_.obey};
  auto sink = open_sink(opened, options);
  if (!sink) internal::fail(opener_.name_of(uri.text(), port), sink.error());
  outlet->uri = uri.text();
  outlet->port = port;
  outlet->sink = std::move(*sink);
  outlet->conversion = *conversion;
  // By the messages' clock no message is lost.
  if (!module_.message_time_) adapt(outlet, value_or_end(internal::parse_policy(opened)));
  outlets_.push_back(outlet);
  return outlet;
}

/// Makes what thins out and adapts the messages of an outlet.
void Module::Outlets::adapt(const std::shared_ptr<Outlet>& outlet,
                            const internal::Policy& policy) const {
  const Conversion& conversion = outlet->conversion;
  if (conversion.idle_rate > 0)
    outlet->idle = std::make_shared<internal::IdleRate>(conversion.idle_rate);
  if (policy.bandwidth == 0) return;
  const internal::Form best{conversion.quality.value_or(kJpegQuality), conversion.scale};
  const bool may_scale = (*parse_uri(outlet->uri)).option("scale", "").empty();
  const internal::Adaptation::Limits limits{policy.bandwidth, best, may_scale,
                                            !policy.writer_waits()};
  for (const auto& other : outlets_)
    if (!conversion.pair.empty() && other->conversion.pair == conversion.pair && other->adapted &&
        other->adapted->adaptation.limits() == limits)
      outlet->adapted = other->adapted;
  if (!outlet->adapted)
    outlet->adapted = std::make_shared<internal::AdaptedLinks>(
        internal::AdaptedLinks{internal::Adaptation(limits), {}});
  outlet->adapted->outlets.push_back(outlet);
}

void Module::Outlets::open(const internal::PortLink& link) {
  auto& output = output_of(link);
  auto outlet = open(link.uri, output.name, output.options.keep);
  outlet->first = output.seq;
  output.links.push_back(std::move(outlet));
}

void Module::Outlets::open(const internal::Arguments& arguments) {
  is_late_ = arguments.joins;
  for (const auto& link : arguments.outputs) open(link);
  const auto shares = [](const auto& output) { return !output->options.on_demand; };
  const auto first = std::ranges::find_if(module_.outputs_, shares);
  if (first != module_.outputs_.end() && !arguments.control &&
      std::ranges::all_of(arguments.outputs, &internal::PortLink::is_trace)) {
    const auto standard_output = open({"-", "", {}}, (*first)->name, 0);
    for (auto& output : module_.outputs_)
      if (shares(output)) output->links.push_back(standard_output);
  }
  is_late_ = true;
}

std::shared_ptr<Outlet> Module::Outlets::abandon(const internal::PortLink& link) {
  const auto& links = output_of(link).links;
  const auto found = std::ranges::find(links, link.uri.text(), &Outlet::uri);
  if (found == links.end()) return nullptr;
  // Closing would wait for a slow reader.
  if (auto* sink = (*found)->sink.get()) {
    const auto before = sink->traffic().dropped_disconnect;
    sink->abandon();
    if (const auto lost = sink->traffic().dropped_disconnect - before; lost > 0)
      module_.log((*found)->port + ": " + std::to_string(lost) + " waiting, lost with the link");
  }
  return *found;
}

void Module::Outlets::remove(const internal::PortLink& link,
                             const std::shared_ptr<Outlet>& outlet) {
  removed_.push_back(outlet);
  std::erase(outlets_, outlet);
  std::erase(output_of(link).links, outlet);
}

void Module::Outlets::set_route(const std::string& link, const internal::Route& route) {
  for (auto& outlet : outlets_)
    if (outlet->port + "=" + outlet->uri == link) outlet->route = route;
}

void Module::Outlets::count_peers() {
  for (const auto& outlet : outlets_) {
    const auto peers = outlet->sink ? outlet->sink->peers() : std::nullopt;
    outlet->peers = peers ? static_cast<std::int64_t>(*peers) : -1;
  }
}

void Module::Outlets::add_counters(std::vector<LinkCounters>& rows) const {
  for (const auto& outlet : outlets_) {
    auto& row = rows.emplace_back();
    row.traffic = outlet->counted();
    row.peers = outlet->peers;
    if (!outlet->adapted) continue;
    const auto form = outlet->adapted->adaptation.form();
    row.quality = form.quality;
    row.scale = std::lround(1000 * form.scale);
  }
}

void Module::Outlets::add_ends(std::vector<LinkEnd>& rows) const {
  for (const auto& outlet : outlets_) rows.push_back({false, outlet->port, outlet->uri});
}

std::size_t Module::Outlets::index_of(const Outlet* outlet) const {
  const auto found =
      std::ranges::find_if(outlets_, [&](const auto& each) { return each.get() == outlet; });
  return static_cast<std::size_t>(found - outlets_.begin());
}

Status Module::Outlets::close() {
  Status failure;
  for (auto& outlet : outlets_) {
    if (outlet->sink == nullptr) continue;
    auto closed = outlet->sink->close();
    outlet->traffic = outlet->sink->traffic();
    if (failure && !closed && closed.error().code != Code::Closed)
      failure = Error{closed.error().code, outlet->uri + ": " + closed.error().detail};
  }
  return failure;
}

}  // namespace hc
