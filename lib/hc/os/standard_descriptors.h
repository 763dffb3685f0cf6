// SPDX-License-Identifier: Apache-2.0
#pragma once
// Standard input, output and error of a program that was started without them.

namespace hc {

/// Opens /dev/null for those of the descriptors 0 to 2 that are closed: else the first file that is
/// opened would get what is written to standard output or error. Called first thing in a program.
void open_standard_descriptors();

}  // namespace hc
