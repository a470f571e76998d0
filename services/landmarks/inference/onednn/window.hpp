// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/landmarks/inference/onednn/builder.hpp"

namespace handcast::landmarks::onednn {

/// The window of a convolution or a pool. One number per spatial axis.
struct Window {
  /// As in ONNX. A dilation is the step between samples: 1 means no gap.
  /// @{
  Shape kernel, strides, dilations;
  /// @}
  /// Padding at the beginning and at the end.
  /// @{
  Shape before, after;
  /// @}
  /// oneDNN's dilations: the gaps between samples, the steps less 1.
  Shape gaps() const;
};

/// The window of a node. Throws Refused if it is not valid (strides of 0, another number of axes).
Window window_of(const Node& node, const Shape& input, const Shape& kernel);

/// The spatial extents of the result. `ceil`: windows that reach beyond the edge count, and
/// `window.after` is enlarged for them. Throws Refused if the padding exceeds the kernel.
Shape extents_after(const Node& node, Window& window, const Shape& input, bool ceil = false);

/// The spatial extents: all but the first two.
Shape spatial(const Shape& shape);
/// The shape [batch, channels, extents...].
Shape image_shape(std::int64_t batch, std::int64_t channels, const Shape& extents);

}  // namespace handcast::landmarks::onednn
