// SPDX-License-Identifier: Apache-2.0
// The table of transports, by URI scheme.
#include <algorithm>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <hc/base/suggestion.h>
#include <hc/link/link.h>
#include <hc/link/policy.h>
#include <hc/link/stream/ends.h>
#include <hc/link/transports.h>

namespace hc {
namespace {

Status check_name(const Uri& uri) {
  if (uri.rest.empty() || uri.rest == "@") return Error{Code::Invalid, "the URI has no name"};
  return {};
}

/// The transports of this program; add_transport() adds more. Lists the options of each end, so
/// that misspelt ones are refused.
std::vector<Transport>& table() {
  using namespace internal;
  static std::vector<Transport> transports = {
      {"-", "", kPolicyOptions, open_stdin, open_stdout, [](const Uri&) { return Status(); }},
      {"file", "", std::string("append optional ") + kPolicyOptions, open_file_source,
       open_file_sink, check_name},
      dialing<tcp_peer>("tcp", "same_user", check_host_port),
      listening<listen_tcp>("tcp-listen", "same_user", check_host_port),
      dialing<unix_peer>("unix", "", check_name),
      listening<listen_unix>("unix-listen", "", check_name),
      {"inproc", "", kPolicyOptions, open_inproc_source, open_inproc_sink, check_name},
      {"shm", "keep rate burst bandwidth spin wait reconnect",
       "readers stay wait keep bandwidth memory timeout", open_shm_source, open_shm_sink,
       check_name},
  };
  return transports;
}

std::vector<std::string> split(std::string_view words) {
  std::istringstream text{std::string(words)};
  return {std::istream_iterator<std::string>(text), {}};
}

/// Whether any end of any transport has this option; if so, it is not misspelt.
bool is_option(const std::string& key) {
  return std::ranges::any_of(table(), [&](const Transport& each) {
    return std::ranges::count(split(each.source_options + " " + each.sink_options), key) > 0;
  });
}

Result<const Transport*> find_transport(const Uri& uri) {
  std::string known;
  for (const Transport& transport : table()) {
    if (transport.scheme == uri.scheme) return &transport;
    known.append(known.empty() ? "" : ", ").append(transport.scheme);
  }
  const bool is_optional = uri.scheme == "tls" || uri.scheme == "tls-listen" || uri.scheme == "dds";
  return Error{Code::Invalid,
               "no transport \"" + uri.scheme + "\"; available: " + known +
                   (is_optional ? "; tls and dds need OpenSSL and Cyclone DDS when a program is "
                                  "built, and hc::add_all_transports() in its main()"
                                : "")};
}

Status check_options(const Uri& uri, std::string_view allowed) {
  const auto known = split(allowed);
  std::string list;
  for (const auto& word : known)
    list.append(list.empty() ? ", only \"" : ", \"").append(word + '"');
  for (const auto& [key, value] : uri.options) {
    if (std::find(known.begin(), known.end(), key) == known.end())
      return Error{Code::Invalid, uri.scheme + " has no option \"" + key + "\" here" + list +
                                      (is_option(key) ? "" : suggestion(key, known))};
    if (value.empty()) return Error{Code::Invalid, "option " + key + " has no value"};
  }
  return {};
}

/// Checks the address and the values of the options.
Status check_end(const Transport& transport, const Uri& uri, std::string_view allowed) {
  HC_TRY(check_options(uri, allowed));
  HC_TRY(transport.check(uri));
  for (const char* key : {"wait", "reconnect", "readers", "stay", "spin", "same_user", "domain",
                          "append", "optional"})
    HC_TRY(number_option(uri, key, 0));
  HC_TRY(internal::parse_policy(uri));
  return {};
}

/// The options with a log that prefixes lines with the URI.
LinkOptions with_uri_prefix(LinkOptions options, const Uri& uri) {
  if (!options.log) return options;
  options.log = [log = options.log, name = uri.text() + ": "](Level severity,
                                                              std::string_view line) {
    log(severity, name + std::string(line));
  };
  return options;
}

}  // namespace

void add_transport(Transport transport) {
  for (const Transport& each : table())
    if (each.scheme == transport.scheme) return;
  table().push_back(std::move(transport));
}

std::vector<std::string_view> transports() {
  std::vector<std::string_view> schemes;
  schemes.reserve(table().size());
  for (const Transport& transport : table()) schemes.push_back(transport.scheme);
  return schemes;
}

Result<std::unique_ptr<Source>> open_source(const Uri& uri, const LinkOptions& options) {
  auto transport = HC_TRY(find_transport(uri));
  HC_TRY(check_options(uri, transport->source_options));
  return transport->open_source(uri, with_uri_prefix(options, uri));
}

Result<std::unique_ptr<Sink>> open_sink(const Uri& uri, const LinkOptions& options) {
  auto transport = HC_TRY(find_transport(uri));
  HC_TRY(check_options(uri, transport->sink_options));
  return transport->open_sink(uri, with_uri_prefix(options, uri));
}

Status check_source(const Uri& uri) {
  const auto* transport = HC_TRY(find_transport(uri));
  return check_end(*transport, uri, transport->source_options);
}

Status check_sink(const Uri& uri) {
  const auto* transport = HC_TRY(find_transport(uri));
  return check_end(*transport, uri, transport->sink_options);
}

}  // namespace hc
