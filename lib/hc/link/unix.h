// SPDX-License-Identifier: Apache-2.0
#pragma once
// Unix sockets by URI, for the transports that are made of them. Internal.

#include <hc/base/uri.h>
#include <hc/link/socket.h>

namespace hc::internal {

/// A socket that listens at `unix:PATH` or `unix:@NAME`; of those that connect to a @NAME only
/// processes of this user are let in. Errors: Usage, System.
Result<ListeningSocket> listen_unix(const Uri& uri);

/// A connection to who listens there. Errors: Usage, and as connect_to().
Result<Descriptor> connect_unix(const Uri& uri, const LinkOptions& options);

}  // namespace hc::internal
