// SPDX-License-Identifier: Apache-2.0
#pragma once
// Registers our own layers with OpenCV.

#include <mutex>

#include <opencv2/dnn/dnn.hpp>

namespace hc::nets {

/// Registers a layer with OpenCV, so that networks can name it by its type. May be called again.
/// @tparam OwnLayer  a cv::dnn::Layer that is made from its parameters.
template <typename OwnLayer>
void register_layer(const char* type) {
  using Params = cv::dnn::LayerParams;
  static std::once_flag once;
  std::call_once(once, [type] {
    cv::dnn::LayerFactory::registerLayer(type, [](Params& params) -> cv::Ptr<cv::dnn::Layer> {
      return cv::makePtr<OwnLayer>(params);
    });
  });
}

}  // namespace hc::nets
