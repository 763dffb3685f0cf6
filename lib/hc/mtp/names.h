// SPDX-License-Identifier: Apache-2.0
#pragma once
// Matrix types, scalars and encodings by the names that people write; name() is the way back. Pure.

#include <optional>
#include <string_view>

#include <hc/mtp/element.h>

namespace hc {

/// The type, scalar or encoding of that name; nothing where there is none.
std::optional<MatrixType> matrix_type_of(std::string_view name);
std::optional<Scalar> scalar_of(std::string_view name);
std::optional<Encoding> encoding_of(std::string_view name);

}  // namespace hc
