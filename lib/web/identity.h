// SPDX-License-Identifier: Apache-2.0
#pragma once
// The server's certificate, made once and kept, so that browsers need to accept it only once.

#include <string>

#include <hc/base/result.h>

namespace hc::web {

/// The certificate and its key in PEM, from page_key.pem in a folder; makes that file if it does
/// not exist (tls::make_key()).
///
/// Errors: System (folder not writable, or file not readable), Malformed (other contents).
Result<std::string> load_identity(const std::string& folder);

/// The SHA-256 fingerprint of a certificate in PEM, as browsers show it: "AB:CD:…"; empty: none.
std::string fingerprint(const std::string& pem);

/// The folder of a user's settings: $XDG_CONFIG_HOME/hypercolumn or ~/.config/hypercolumn.
std::string settings_folder();

}  // namespace hc::web
