// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages as Eigen matrices and back, without a copy. Header only; a target of its own, hc::eigen.

#include <Eigen/Core>

#include <hc/mtp/message.h>

namespace hc {

/// Rows and columns of scalars, row by row as the format has them.
template <typename T>
using RowMajor = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The elements as a matrix of `height` rows and `width × components` columns: a transformation as
/// it is, a path of positions with a row for each when it has width 1. Views the message, which
/// must live longer.
///
/// Errors: Unsupported (compressed; another scalar than T).
template <ScalarType T>
Result<Eigen::Map<const RowMajor<T>>> as_eigen(const Message& message) {
  auto view = message.view<T>();
  if (!view) return view.error();
  return Eigen::Map<const RowMajor<T>>(
      view->numbers().data(), static_cast<Eigen::Index>(view->height()),
      static_cast<Eigen::Index>(view->width() * view->components()));
}

/// The elements of a draft, to be written to in place. Another scalar than the draft's is a bug.
template <ScalarType T>
Eigen::Map<RowMajor<T>> as_eigen(const Draft& draft) {
  auto view = draft.view<T>();
  return Eigen::Map<RowMajor<T>>(view.numbers().data(), static_cast<Eigen::Index>(view.height()),
                                 static_cast<Eigen::Index>(view.width() * view.components()));
}

}  // namespace hc
