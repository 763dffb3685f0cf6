// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/names.h>

namespace hc {
namespace {

template <typename E>
std::optional<E> find_name(std::string_view wanted, E first, E last) {
  for (int i = static_cast<int>(first); i <= static_cast<int>(last); ++i)
    if (name(static_cast<E>(i)) == wanted) return static_cast<E>(i);
  return std::nullopt;
}

}  // namespace

std::optional<MatrixType> matrix_type_of(std::string_view name) {
  return find_name(name, MatrixType::Position, MatrixType::Table);
}
std::optional<Scalar> scalar_of(std::string_view name) {
  return find_name(name, Scalar::U8, Scalar::F64);
}
std::optional<Encoding> encoding_of(std::string_view name) {
  return find_name(name, Encoding::Text, Encoding::Jpeg);
}

}  // namespace hc
