// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages as cv::Mat and back, without a copy. Header only; target hc::opencv.

#include <concepts>
#include <cstring>
#include <string>

#include <hc/module/kind.h>
#include <opencv2/core.hpp>

namespace hc {

/// OpenCV's depth of a scalar: CV_8U … CV_64F.
///
/// Errors: Unsupported (u32, u64 and i64, which OpenCV lacks).
inline Result<int> cv_depth(Scalar scalar) {
  const int depth = visit_scalar(scalar, [](auto zero) {
    if constexpr (requires { cv::DataType<decltype(zero)>::depth; })
      return static_cast<int>(cv::DataType<decltype(zero)>::depth);
    else
      return -1;
  });
  if (depth >= 0) return depth;
  return Error{Code::Unsupported, "OpenCV has no matrix of " + std::string(name(scalar))};
}

/// A kind whose scalar OpenCV supports.
template <typename K>
concept OpenCvKind = ScalarType<typename K::Scalar> && cv::DataType<typename K::Scalar>::depth >= 0;

/// The elements as a matrix of the same shape, (height, width, components), with the channels of
/// the format, r g b for colour images. Views the message, which must live longer; read-only.
///
/// Errors: Unsupported (compressed; a scalar that OpenCV lacks).
inline Result<cv::Mat> as_mat(const Message& message) {
  if (!message.plain())
    return Error{Code::Unsupported,
                 "the elements are compressed: " + std::string(name(message.header.info.encoding))};
  auto depth = HC_TRY(cv_depth(message.header.info.scalar));
  return cv::Mat(message.header.height, message.header.width,
                 CV_MAKETYPE(depth, message.header.info.components),
                 const_cast<std::byte*>(message.elements.data()));
}

/// The same for the typed, uncompressed message of a handler.
template <OpenCvKind K>
cv::Mat as_mat(const MessageOf<K>& message) {
  return *as_mat(static_cast<const Message&>(message));
}

/// The elements of a draft. OpenCV reallocates if shape or type differ: see fill().
template <OpenCvKind K>
cv::Mat as_mat(const DraftOf<K>& draft) {
  return {draft.header.height, draft.header.width,
          CV_MAKETYPE(cv::DataType<typename K::Scalar>::depth, draft.header.info.components),
          draft.elements().data()};
}

/// Copies a matrix into a draft, unless it views the draft already. The matrix must have the
/// draft's shape and type.
template <OpenCvKind K>
void fill(const DraftOf<K>& draft, const cv::Mat& mat) {
  cv::Mat own = as_mat(draft);
  HC_CHECK(mat.size() == own.size() && mat.type() == own.type(), mat.rows, mat.cols, mat.type());
  if (mat.data != own.data) mat.copyTo(own);
}

/// Writes a draft in place. A reallocated result is copied; it must have the draft's shape and
/// type.
///
///     hc::fill(draft, [&](cv::Mat& rgb) { cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB); });
template <OpenCvKind K, std::invocable<cv::Mat&> Write>
void fill(const DraftOf<K>& draft, Write write) {
  cv::Mat mat = as_mat(draft);
  write(mat);
  fill(draft, mat);
}

}  // namespace hc
