// SPDX-License-Identifier: Apache-2.0
#pragma once
// The server's own certificate, made once and kept, so that a browser that has accepted it knows it
// again.

#include <string>

#include <hc/base/result.h>

#include <web/server.h>

namespace hc::web {

/// Reads the certificate and key in a folder, page_certificate.pem and page_key.pem, or makes them:
/// P-256, self-signed, for 20 years. The key can be read by its user alone.
///
/// Errors: System (the folder cannot be written), Malformed (a file holds something else).
Result<Identity> load_identity(const std::string& folder);

/// The SHA-256 fingerprint of a certificate, as browsers show it: "AB:CD:…".
Result<std::string> fingerprint(const std::string& certificate);

/// Where a user's settings are: $XDG_CONFIG_HOME/hypercolumn or ~/.config/hypercolumn.
std::string settings_folder();

}  // namespace hc::web
