// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/landmarks/inference/onednn/builder.hpp"

namespace handcast::landmarks::onednn {

/// How a window moves over an image: for convolutions and pools. One number per spatial axis.
struct Window {
  Shape kernel, strides, dilations, before, after;  ///< before, after: padding

  /// oneDNN counts the gaps, ONNX the steps.
  Shape gaps() const;
};

/// Refuses what no network means: strides of 0, padding beyond the kernel.
Window window_of(const Node& node, const Shape& input, const Shape& kernel);

/// The spatial extents that come out; `ceil`: a window that hangs over the edge counts, and
/// `window.after` grows to hold it.
Shape extents_after(const Node& node, Window& window, const Shape& input, bool ceil = false);

/// The extents after the first two.
Shape spatial(const Shape& shape);
/// [batch, channels, extents...]
Shape image_shape(std::int64_t batch, std::int64_t channels, const Shape& extents);

}  // namespace handcast::landmarks::onednn
