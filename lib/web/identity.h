// SPDX-License-Identifier: Apache-2.0
#pragma once
// The server's own certificate, made once and kept, so that a browser that has accepted it knows it
// again.

#include <string>

#include <hc/base/result.h>

namespace hc::web {

/// The certificate and its key in a folder, PEM, from page_key.pem, which is made where it is not
/// there (tls::make_key()).
///
/// Errors: System (the folder cannot be written, or the file not be read), Malformed (the file
/// holds something else).
Result<std::string> load_identity(const std::string& folder);

/// The SHA-256 fingerprint of a certificate in PEM, as browsers show it: "AB:CD:…"; empty: none.
std::string fingerprint(const std::string& pem);

/// Where a user's settings are: $XDG_CONFIG_HOME/hypercolumn or ~/.config/hypercolumn.
std::string settings_folder();

}  // namespace hc::web
