// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages as cv::Mat and back, without a copy. Header only; a target of its own, hc::opencv.

#include <concepts>
#include <cstring>
#include <string>

#include <hc/module/kind.h>
#include <opencv2/core.hpp>

namespace hc {

/// OpenCV's depth of a scalar: CV_8U … CV_64F.
///
/// Errors: Unsupported (u32, u64 and i64, which OpenCV does not have).
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

/// A kind whose scalar OpenCV has.
template <typename K>
concept OpenCvKind = ScalarType<typename K::Scalar> && cv::DataType<typename K::Scalar>::depth >= 0;

/// The elements as a matrix of the same shape, (height, width, components); a colour image has
/// its channels in the order of the format, r g b. Views the message, which must live longer, and
/// must not be written to.
///
/// Errors: Unsupported (compressed; a scalar that OpenCV does not have).
inline Result<cv::Mat> as_mat(const Message& message) {
  if (!message.plain())
    return Error{Code::Unsupported,
                 "the elements are compressed: " + std::string(name(message.header.info.encoding))};
  auto depth = HC_TRY(cv_depth(message.header.info.scalar));
  return cv::Mat(message.header.height, message.header.width,
                 CV_MAKETYPE(depth, message.header.info.components),
                 const_cast<std::byte*>(message.elements.data()));
}

/// The same of a handler's message, which is plain and of its kind.
template <OpenCvKind K>
cv::Mat as_mat(const MessageOf<K>& message) {
  return *as_mat(static_cast<const Message&>(message));
}

/// The elements of a draft. OpenCV writes there only while shape and type stay: see fill().
template <OpenCvKind K>
cv::Mat as_mat(const DraftOf<K>& draft) {
  return {draft.header.height, draft.header.width,
          CV_MAKETYPE(cv::DataType<typename K::Scalar>::depth, draft.header.info.components),
          draft.elements().data()};
}

/// Has a draft hold the numbers of a matrix; a matrix that views the draft already is not copied.
/// Another shape or type than the draft's is a bug.
template <OpenCvKind K>
void fill(const DraftOf<K>& draft, const cv::Mat& mat) {
  cv::Mat own = as_mat(draft);
  HC_CHECK(mat.size() == own.size() && mat.type() == own.type(), mat.rows, mat.cols, mat.type());
  if (mat.data != own.data) mat.copyTo(own);
}

/// Writes a draft in place. OpenCV's functions reallocate their result where shape or type
/// differ from what they are given; then it is copied where only the memory differs, and a bug
/// where shape or type do.
///
///     hc::fill(draft, [&](cv::Mat& rgb) { cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB); });
template <OpenCvKind K, std::invocable<cv::Mat&> Write>
void fill(const DraftOf<K>& draft, Write write) {
  cv::Mat mat = as_mat(draft);
  write(mat);
  fill(draft, mat);
}

}  // namespace hc
