// SPDX-License-Identifier: Apache-2.0
// The one table of transports: what the scheme of a URI opens.
#include <algorithm>
#include <array>
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

using Opened = Result<std::unique_ptr<Source>>;
using OpenedSink = Result<std::unique_ptr<Sink>>;

struct Transport {
  std::string_view scheme;
  std::string_view source_options, sink_options;  // names, with blanks between
  Opened (*open_source)(const Uri&, const LinkOptions&);
  OpenedSink (*open_sink)(const Uri&, const LinkOptions&);
};

/// Calls a function of a transport; null: it is in a library that this program is linked without.
template <typename Function, typename... Options>
auto call(Function* function, const Uri& uri, const Options&... options)
    -> decltype(function(uri, options...)) {
  if (function != nullptr) return function(uri, options...);
  const bool is_tls = uri.scheme.starts_with("tls");
  const std::string name = is_tls ? "tls" : "dds";
  return Error{Code::Unsupported, name + ": links need " + (is_tls ? "OpenSSL" : "Cyclone DDS") +
                                      ": this program is linked without lib/" + name};
}

// The ends of links between sockets that connect, and that listen.

template <Result<internal::Peer> find(const Uri&)>
Opened connect_source(const Uri& uri, const LinkOptions& options) {
  auto peer = call(find, uri);
  return peer ? internal::dial_source(*peer, uri, options) : peer.error();
}

template <Result<internal::Peer> find(const Uri&)>
OpenedSink connect_sink(const Uri& uri, const LinkOptions& options) {
  auto peer = call(find, uri);
  return peer ? internal::dial_sink(*peer, uri, options) : peer.error();
}

template <Result<internal::ListeningSocket> listen(const Uri&)>
Opened listening_source(const Uri& uri, const LinkOptions& options) {
  auto socket = call(listen, uri);
  return socket ? internal::listening_source(std::move(*socket), options) : socket.error();
}

template <Result<internal::ListeningSocket> listen(const Uri&)>
OpenedSink listening_sink(const Uri& uri, const LinkOptions& options) {
  auto socket = call(listen, uri);
  return socket ? internal::listening_sink(std::move(*socket), uri, options) : socket.error();
}

/// Every transport there is. The options of each end are listed here, so that a misspelt one is
/// refused and not ignored.
constexpr std::array<Transport, 11> kTransports = {{
    {"-", "", "keep rate burst memory timeout", internal::open_stdin, internal::open_stdout},
    {"file", "", "append optional keep rate burst memory timeout", internal::open_file_source,
     internal::open_file_sink},
    {"tcp", "wait reconnect same_user", "wait reconnect same_user keep rate burst memory timeout",
     connect_source<internal::tcp_peer>, connect_sink<internal::tcp_peer>},
    {"tcp-listen", "same_user", "readers stay same_user keep rate burst memory timeout",
     listening_source<internal::listen_tcp>, listening_sink<internal::listen_tcp>},
    {"tls", "key peer wait reconnect", "key peer wait reconnect keep rate burst memory timeout",
     connect_source<internal::tls_peer>, connect_sink<internal::tls_peer>},
    {"tls-listen", "key peer", "key peer readers stay keep rate burst memory timeout",
     listening_source<internal::listen_tls>, listening_sink<internal::listen_tls>},
    {"unix", "wait reconnect", "wait reconnect keep rate burst memory timeout",
     connect_source<internal::unix_peer>, connect_sink<internal::unix_peer>},
    {"unix-listen", "", "readers stay keep rate burst memory timeout",
     listening_source<internal::listen_unix>, listening_sink<internal::listen_unix>},
    {"inproc", "", "keep rate burst memory timeout", internal::open_inproc_source,
     internal::open_inproc_sink},
    {"shm", "keep rate burst spin wait reconnect", "readers stay keep memory timeout",
     internal::open_shm_source, internal::open_shm_sink},
    {"dds", "domain interface wait reconnect keep rate burst memory",
     "domain interface readers stay keep rate burst memory timeout", internal::open_dds_source,
     internal::open_dds_sink},
}};

std::vector<std::string> split(std::string_view words) {
  std::istringstream text{std::string(words)};
  return {std::istream_iterator<std::string>(text), {}};
}

/// Whether some end of some transport has an option of that name: then it is not misspelt.
bool is_option(const std::string& key) {
  std::string all;
  for (const Transport& transport : kTransports)
    all.append(" ").append(transport.source_options).append(" ").append(transport.sink_options);
  auto words = split(all);
  return std::find(words.begin(), words.end(), key) != words.end();
}

Result<const Transport*> find_transport(const Uri& uri) {
  std::string known;
  for (const Transport& transport : kTransports) {
    if (transport.scheme == uri.scheme) return &transport;
    known.append(known.empty() ? "" : ", ").append(transport.scheme);
  }
  return Error{Code::Invalid, "no transport \"" + uri.scheme + "\"; there are " + known};
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

/// Whether an end can be where it says, and its options have values that they can have.
Status check_end(const Uri& uri, std::string_view allowed) {
  if (auto checked = check_options(uri, allowed); !checked) return checked;
  const bool is_tls = uri.scheme.starts_with("tls");
  if (is_tls || uri.scheme.starts_with("tcp")) {
    if (auto place = parse_host_port(uri.rest); !place) return place.error();
    for (const char* key : {"key", "peer"})
      if (is_tls && uri.option(key, "").empty())
        return Error{
            Code::Invalid,
            uri.scheme +
                " needs the options key=FILE and peer=FINGERPRINT; hc key FILE makes a key"};
  } else if (uri.scheme != "-" && (uri.rest.empty() || uri.rest == "@")) {
    return Error{Code::Invalid, "there is no name"};
  }
  for (const char* key : {"wait", "reconnect", "readers", "stay", "spin", "same_user", "domain",
                          "append", "optional"})
    if (auto number = number_option(uri, key, 0); !number) return number.error();
  auto policy = internal::parse_policy(uri);
  return policy ? Status() : policy.error();
}

/// The options with a log whose lines begin with the link's name.
LinkOptions with_name(LinkOptions options, const Uri& uri) {
  if (!options.log) return options;
  options.log = [log = options.log, name = uri.text() + ": "](Severity severity,
                                                              std::string_view line) {
    log(severity, name + std::string(line));
  };
  return options;
}

}  // namespace

std::vector<std::string_view> transports() {
  std::vector<std::string_view> schemes;
  schemes.reserve(kTransports.size());
  for (const Transport& transport : kTransports) schemes.push_back(transport.scheme);
  return schemes;
}

Result<std::unique_ptr<Source>> open_source(const Uri& uri, const LinkOptions& options) {
  auto transport = find_transport(uri);
  if (!transport) return transport.error();
  auto checked = check_options(uri, (*transport)->source_options);
  if (!checked) return checked.error();
  return call((*transport)->open_source, uri, with_name(options, uri));
}

Result<std::unique_ptr<Sink>> open_sink(const Uri& uri, const LinkOptions& options) {
  auto transport = find_transport(uri);
  if (!transport) return transport.error();
  auto checked = check_options(uri, (*transport)->sink_options);
  if (!checked) return checked.error();
  return call((*transport)->open_sink, uri, with_name(options, uri));
}

Status check_source(const Uri& uri) {
  auto transport = find_transport(uri);
  return transport ? check_end(uri, (*transport)->source_options) : transport.error();
}

Status check_sink(const Uri& uri) {
  auto transport = find_transport(uri);
  return transport ? check_end(uri, (*transport)->sink_options) : transport.error();
}

}  // namespace hc
