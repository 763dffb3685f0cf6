// SPDX-License-Identifier: Apache-2.0
#pragma once
// What the shapes in a network must be. Pure.

#include <hc/base/result.h>
#include <nets/layers.h>

namespace hc::nets {

/// The window of a convolution or pool, and the zeros around its image. [px]
struct Window {
  int height = 1, width = 1;
  int top = 0, bottom = 0, left = 0, right = 0;
};
/// @param weights  of a convolution; {} of a pool.
Window window_of(const Layer& layer, const Shape& image, const Shape& weights);

/// The axis of a concatenation, counted from the first.
int axis_of(const Layer& layer, const Shape& shape);

/// Whether each layer takes what was computed before it, or a constant where it has to be one, and
/// its shape follows from theirs.
///
/// Errors: Malformed, Unsupported, TooLarge (see Network::make()).
Status check_shapes(const Layers& layers);

/// The same network for images of another size, if it computes the same everywhere in an image:
/// with convolutions, pools and resizes, and flattens what they give at the end.
/// @param height, width  [px]
///
/// Errors: those of check_shapes(); Unsupported (not such a network, or the extent of a result
/// would not be whole), TooLarge (more than kMostNumbers in the image and all results).
Result<Layers> resized(Layers layers, int height, int width);

}  // namespace hc::nets
