// SPDX-License-Identifier: Apache-2.0
// MaxPool, AveragePool, GlobalAveragePool, GlobalMaxPool, Resize: windows without weights.
#include <fmt/format.h>

#include <cmath>

#include "services/landmarks/inference/onednn/operators.hpp"
#include "services/landmarks/inference/onednn/window.hpp"

namespace handcast::landmarks::onednn {

namespace {

using dnnl::algorithm;
using dnnl::prop_kind;

void add_pool(Builder& builder, const Node& node, algorithm kind, const Window& window,
              const Shape& result) {
  const Value input = builder.operand(node, 0);
  const dnnl::pooling_v2_forward::desc operation(prop_kind::forward_inference, kind, input.desc,
                                                 any_desc(result), window.strides, window.kernel,
                                                 window.gaps(), window.before, window.after);
  const dnnl::pooling_v2_forward::primitive_desc chosen(operation, own_scratchpad(),
                                                        builder.engine());
  const Value output = builder.make(chosen.dst_desc());
  builder.program().add_step(dnnl::pooling_v2_forward(chosen),
                             {{DNNL_ARG_SRC, input}, {DNNL_ARG_DST, output}},
                             chosen.scratchpad_desc());
  builder.define(node.outputs[0], output);
}

std::size_t emit_pool(Builder& builder, const Node& node, std::span<const Node>) {
  const Shape input = builder.operand(node, 0).desc.dims();
  if (input.size() < 3 || node.outputs.size() != 1)
    refuse(node, "has an input that is not an image, or a second output");
  Window window = window_of(node, input, node.integers("kernel_shape", {}));
  const bool with_padding = node.integer("count_include_pad", 0) != 0;
  const algorithm average = with_padding ? algorithm::pooling_avg_include_padding
                                         : algorithm::pooling_avg_exclude_padding;
  const Shape extents = extents_after(node, window, input, node.integer("ceil_mode", 0) != 0);
  add_pool(builder, node, node.op == "MaxPool" ? algorithm::pooling_max : average, window,
           image_shape(input[0], input[1], extents));
  return 0;
}

std::size_t emit_global_pool(Builder& builder, const Node& node, std::span<const Node>) {
  const Shape input = builder.operand(node, 0).desc.dims();
  if (input.size() < 3 || input.size() > 5) refuse(node, "has an input that is not an image");
  const Shape extents = spatial(input), ones(extents.size(), 1), zeros(extents.size(), 0);
  const algorithm kind =
      node.op == "GlobalMaxPool" ? algorithm::pooling_max : algorithm::pooling_avg_exclude_padding;
  add_pool(builder, node, kind, {extents, ones, ones, zeros, zeros},
           image_shape(input[0], input[1], ones));
  return 0;
}

/// The shape of a Resize's result: from its sizes (input 3) or its scales (input 2, or input 1 of
/// Upsample).
Shape resized(const Builder& builder, const Node& node, const Shape& input) {
  const bool old = node.op == "Upsample";
  Shape shape = old ? Shape{} : builder.integers(node, 3).value_or(Shape{});
  if (shape.empty()) {
    const onnx::Tensor* scales = builder.constant(node, old ? 1 : 2);
    if (!scales || scales->floats.size() != input.size())
      refuse(node, "has no scales or sizes that fit its input");
    for (std::size_t i = 0; i < input.size(); ++i) {
      const float extent = std::floor(static_cast<float>(input[i]) * scales->floats[i]);
      shape.push_back(extent >= 1 && extent < 65536 ? static_cast<std::int64_t>(extent) : 0);
    }
  }
  const bool fits = shape.size() == input.size() && shape.size() >= 3 && shape.size() <= 5 &&
                    shape[0] == input[0] && shape[1] == input[1];
  if (!fits || onnx::elements(shape) == 0)
    refuse(node,
           fmt::format("cannot resize {} to {}", onnx::to_string(input), onnx::to_string(shape)));
  return shape;
}

/// oneDNN samples at the centres of pixels (half_pixel). For integer factors, the other modes of
/// "nearest" have the same result.
algorithm resampling_of(const Node& node, const Shape& input, const Shape& result) {
  const std::string mode = node.text("mode", "nearest");
  const std::string where = node.text("coordinate_transformation_mode",
                                      node.op == "Upsample" ? "asymmetric" : "half_pixel");
  if (mode == "linear" && (where == "half_pixel" || where == "pytorch_half_pixel"))
    return algorithm::resampling_linear;
  bool whole = where != "align_corners";
  for (std::size_t i = 2; i < input.size(); ++i) whole = whole && result[i] % input[i] == 0;
  const std::string rounding =
      node.text("nearest_mode", node.op == "Upsample" ? "floor" : "round_prefer_floor");
  const bool near = where == "asymmetric" ? rounding == "floor" : rounding.starts_with("round");
  if (mode == "nearest" && whole && near) return algorithm::resampling_nearest;
  refuse(node, fmt::format("resizes by '{}' with '{}', which is not supported", mode, where));
}

std::size_t emit_resize(Builder& builder, const Node& node, std::span<const Node>) {
  const Value input = builder.operand(node, 0);
  const Shape shape = resized(builder, node, input.desc.dims());
  const algorithm kind = resampling_of(node, input.desc.dims(), shape);
  const dnnl::resampling_forward::desc operation(prop_kind::forward_inference, kind, input.desc,
                                                 any_desc(shape));
  const dnnl::resampling_forward::primitive_desc chosen(operation, own_scratchpad(),
                                                        builder.engine());
  const Value output = builder.make(chosen.dst_desc());
  builder.program().add_step(dnnl::resampling_forward(chosen),
                             {{DNNL_ARG_SRC, input}, {DNNL_ARG_DST, output}},
                             chosen.scratchpad_desc());
  builder.define(node.outputs[0], output);
  return 0;
}

constexpr Operator kPoolingOperators[] = {{"MaxPool", emit_pool},
                                          {"AveragePool", emit_pool},
                                          {"GlobalAveragePool", emit_global_pool},
                                          {"GlobalMaxPool", emit_global_pool},
                                          {"Resize", emit_resize},
                                          {"Upsample", emit_resize}};

}  // namespace

std::span<const Operator> pooling_operators() { return kPoolingOperators; }

}  // namespace handcast::landmarks::onednn
