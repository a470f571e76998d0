// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/inference/onednn/window.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace handcast::landmarks::onednn {

namespace {

constexpr std::int64_t kLargest = 4096;  ///< extent of a kernel, stride, dilation, padding

void check_range(const Node& node, const char* what, const Shape& values, std::size_t count,
                 std::int64_t least) {
  if (values.size() != count)
    refuse(node, fmt::format("has {} {}, not {}", values.size(), what, count));
  for (const std::int64_t value : values)
    if (value < least || value > kLargest) refuse(node, fmt::format("has {} of {}", what, value));
}

/// Sets the padding of auto_pad SAME: the result has ceil(input / stride) extents, and an odd row
/// of padding is before or after.
void pad_to_same(const Node& node, Window& window, const Shape& input, bool odd_before) {
  if (node.op == "ConvTranspose") refuse(node, "has auto_pad, which is not supported");
  for (std::size_t i = 0; i < window.kernel.size(); ++i) {
    const std::int64_t steps = (input[i + 2] + window.strides[i] - 1) / window.strides[i];
    const std::int64_t reach = window.dilations[i] * (window.kernel[i] - 1) + 1;
    const std::int64_t whole =
        std::max<std::int64_t>((steps - 1) * window.strides[i] + reach - input[i + 2], 0);
    window.before[i] = odd_before ? whole - whole / 2 : whole / 2;
    window.after[i] = whole - window.before[i];
  }
}

}  // namespace

Shape Window::gaps() const {
  Shape result = dilations;
  for (std::int64_t& gap : result) --gap;
  return result;
}

Window window_of(const Node& node, const Shape& input, const Shape& kernel) {
  const std::size_t axes = kernel.size();
  if (axes < 1 || axes > 3 || input.size() != axes + 2)
    refuse(node, fmt::format("has a kernel of {} over {}", onnx::to_string(kernel),
                             onnx::to_string(input)));
  if (node.integers("kernel_shape", kernel) != kernel)
    refuse(node, "has weights of another shape than its kernel");
  Window window{kernel,
                node.integers("strides", Shape(axes, 1)),
                node.integers("dilations", Shape(axes, 1)),
                {},
                {}};
  const Shape pads = node.integers("pads", Shape(2 * axes, 0));
  check_range(node, "kernel extents", window.kernel, axes, 1);
  check_range(node, "strides", window.strides, axes, 1);
  check_range(node, "dilations", window.dilations, axes, 1);
  check_range(node, "pads", pads, 2 * axes, 0);
  window.before.assign(pads.begin(), pads.begin() + static_cast<std::ptrdiff_t>(axes));
  window.after.assign(pads.begin() + static_cast<std::ptrdiff_t>(axes), pads.end());
  const std::string mode = node.text("auto_pad", "NOTSET");
  if (mode == "SAME_UPPER" || mode == "SAME_LOWER")
    pad_to_same(node, window, input, mode == "SAME_LOWER");
  return window;
}

Shape extents_after(const Node& node, Window& window, const Shape& input, bool ceil) {
  Shape extents;
  for (std::size_t i = 0; i < window.kernel.size(); ++i) {
    const std::int64_t stride = window.strides[i],
                       reach = window.dilations[i] * (window.kernel[i] - 1) + 1;
    if (std::max(window.before[i], window.after[i]) > reach)
      refuse(node, "has more padding than its kernel covers");
    const std::int64_t room = input[i + 2] + window.before[i] + window.after[i] - reach;
    if (room < 0)
      refuse(node, fmt::format("has a kernel larger than its input, {}", onnx::to_string(input)));
    std::int64_t steps = room / stride;
    // A window may reach beyond the end, but must begin in the input or the padding before it.
    if (ceil && room % stride != 0 && (steps + 1) * stride < input[i + 2] + window.before[i])
      ++steps;
    window.after[i] += std::max<std::int64_t>(steps * stride - room, 0);
    extents.push_back(steps + 1);
  }
  return extents;
}

Shape spatial(const Shape& shape) { return {shape.begin() + 2, shape.end()}; }

Shape image_shape(std::int64_t batch, std::int64_t channels, const Shape& extents) {
  Shape shape{batch, channels};
  shape.insert(shape.end(), extents.begin(), extents.end());
  return shape;
}

}  // namespace handcast::landmarks::onednn
