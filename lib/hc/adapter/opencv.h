// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages as cv::Mat and back, without a copy. Header only; a target of its own, hc::opencv.

#include <opencv2/core.hpp>

#include <hc/mtp/message.h>

namespace hc {

/// OpenCV's depth of a scalar: CV_8U … CV_64F.
///
/// Errors: Unsupported (u32, u64 and i64, which OpenCV does not have).
inline Result<int> cv_depth(Scalar scalar) {
  switch (scalar) {
    case Scalar::U8:
      return CV_8U;
    case Scalar::I8:
      return CV_8S;
    case Scalar::U16:
      return CV_16U;
    case Scalar::I16:
      return CV_16S;
    case Scalar::I32:
      return CV_32S;
    case Scalar::F32:
      return CV_32F;
    case Scalar::F64:
      return CV_64F;
    case Scalar::U32:
    case Scalar::U64:
    case Scalar::I64:
      break;
  }
  return Error{Code::Unsupported, "OpenCV has no matrix of " + std::string(name(scalar))};
}

namespace internal {

inline Result<cv::Mat> as_mat(const Header& header, const std::byte* elements) {
  auto depth = cv_depth(header.info.scalar);
  if (!depth) return depth.error();
  return cv::Mat(header.height, header.width, CV_MAKETYPE(*depth, header.info.components),
                 const_cast<std::byte*>(elements));
}

}  // namespace internal

/// The elements as a matrix of the same shape, (height, width, components); a colour picture has
/// its channels in the order of the format, r g b. Views the message, which must live longer, and
/// must not be written to.
///
/// Errors: Unsupported (compressed; a scalar that OpenCV does not have).
inline Result<cv::Mat> as_mat(const Message& message) {
  if (!message.plain())
    return Error{Code::Unsupported, "the elements are " + text(message.header.info)};
  return internal::as_mat(message.header, message.elements.data());
}

/// The elements of a draft, to be written to in place.
///
/// Errors: Unsupported (a scalar that OpenCV does not have).
inline Result<cv::Mat> as_mat(const Draft& draft) {
  return internal::as_mat(draft.header, draft.elements().data());
}

}  // namespace hc
