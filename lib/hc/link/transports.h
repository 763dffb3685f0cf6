// SPDX-License-Identifier: Apache-2.0
#pragma once
// The functions of each transport, of which link.cpp makes the table of schemes. Internal.

#include <memory>
#include <string_view>

#include <hc/link/link.h>
#include <hc/link/stream/dialer.h>
#include <hc/os/socket.h>

namespace hc::internal {

struct Transport {
  std::string_view scheme;
  std::string_view source_options, sink_options;  ///< names, with blanks between
  Result<std::unique_ptr<Source>> (*open_source)(const Uri&, const LinkOptions&);
  Result<std::unique_ptr<Sink>> (*open_sink)(const Uri&, const LinkOptions&);
};

Result<std::unique_ptr<Source>> open_stdin(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Sink>> open_stdout(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Source>> open_file_source(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Sink>> open_file_sink(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Source>> open_inproc_source(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Sink>> open_inproc_sink(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Source>> open_shm_source(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Sink>> open_shm_sink(const Uri&, const LinkOptions&);

/// The ends of `dds:` links. They are in lib/dds, and null in programs that are linked without it.
[[gnu::weak]] Result<std::unique_ptr<Source>> open_dds_source(const Uri&, const LinkOptions&);
[[gnu::weak]] Result<std::unique_ptr<Sink>> open_dds_sink(const Uri&, const LinkOptions&);

// Links between sockets have ends of their own kinds (stream/ends.h); what a transport
// adds is where the sockets are.

/// How an error about the user of a peer begins.
inline constexpr const char* kListener = "the listener is a process of ";
inline constexpr const char* kAccepted = "refused a peer of ";

/// Who listens at `tcp:HOST:PORT` or `unix:PATH`, to be connected to. With `same_user=1` a TCP peer
/// is only of this user or root. Errors: Invalid, NotFound.
Result<Peer> tcp_peer(const Uri& uri);
Result<Peer> unix_peer(const Uri& uri);

/// A socket that listens at `tcp-listen:[HOST:]PORT`, on loopback without a host;
/// `same_user` as above. Errors: Invalid, NotFound, System.
Result<ListeningSocket> listen_tcp(const Uri& uri);
/// A socket that listens at `unix-listen:PATH` or `unix-listen:@NAME`; connections to a @NAME are
/// accepted from processes of this user or root only. Errors: Invalid, System.
Result<ListeningSocket> listen_unix(const Uri& uri);

/// The same of `tls:HOST:PORT` and `tls-listen:[HOST:]PORT`. They are in lib/tls, and null in
/// programs that are linked without it.
[[gnu::weak]] Result<Peer> tls_peer(const Uri& uri);
[[gnu::weak]] Result<ListeningSocket> listen_tls(const Uri& uri);

/// Whether a `memory` is enough for shm, where it is all there is. Errors: Invalid.
Status check_shm_memory(const Uri& uri);

}  // namespace hc::internal
