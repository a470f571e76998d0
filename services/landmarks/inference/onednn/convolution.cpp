// SPDX-License-Identifier: Apache-2.0
// Conv, ConvTranspose, Gemm: layers with weights, fused with the additions and activations after
// them.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <string_view>

#include "services/landmarks/inference/onednn/operators.hpp"
#include "services/landmarks/inference/onednn/post_ops.hpp"
#include "services/landmarks/inference/onednn/window.hpp"

namespace handcast::landmarks::onednn {

namespace {

using dnnl::memory;
using dnnl::prop_kind;

/// The constants of a layer in oneDNN's shapes. A layer without bias has a bias of zeros.
struct Layer {
  const std::vector<float>& weights;
  memory::desc given;  ///< layout of the weights in the file
  std::vector<float> bias;
  std::int64_t positions;  ///< how often each weight is multiplied

  memory::desc bias_desc() const { return plain_desc({static_cast<std::int64_t>(bias.size())}); }
  memory::desc weights_desc() const { return any_desc(given.dims()); }
};

/// The number of positions in an image, or of rows in a matrix.
std::int64_t positions_of(const Shape& shape) { return onnx::elements(shape) / shape[1]; }

/// Whether this is oneDNN's reference implementation, which is a thousand times slower.
template <class PrimitiveDesc>
bool is_reference(const PrimitiveDesc& desc) {
  return std::string_view(desc.impl_info_str()).starts_with("ref");
}

/// A way to compute a layer. `name`: part of the name of oneDNN's implementation; empty: any.
template <class Operation>
struct Candidate {
  Operation operation;
  std::string_view name = {};
};

template <class Operation>
std::vector<Candidate<Operation>> only_candidate(const Operation& operation) {
  return {{operation}};
}

/// oneDNN's implementation of a candidate with all of `post`; empty if there is only the reference
/// implementation.
template <class Choice, class Operation>
Choice choice_of(const Builder& builder, const Candidate<Operation>& candidate,
                 std::span<const PostOp> post) {
  Choice choice(candidate.operation, attributes_with(post), builder.engine(), true);
  const auto fits = [&] {
    return !is_reference(choice) &&
           std::string_view(choice.impl_info_str()).find(candidate.name) != candidate.name.npos;
  };
  while (choice.get(true) && !fits())
    if (!choice.next_impl()) return {};
  return choice;
}

/// The first candidate that supports all of `post`. If there is none, the last candidate; `post` is
/// cut to what it supports.
template <class Choice, class Operation>
Choice choose(const Builder& builder, const std::vector<Candidate<Operation>>& candidates,
              std::vector<PostOp>& post) {
  for (const auto& candidate : candidates)
    if (Choice choice = choice_of<Choice>(builder, candidate, post); choice.get(true))
      return choice;
  for (; !post.empty(); post.pop_back())
    if (Choice choice = choice_of<Choice>(builder, candidates.back(), post); choice.get(true))
      return choice;
  return Choice(candidates.back().operation, attributes_with(post), builder.engine(), true);
}

/// Adds a primitive with its source, weights, bias and post-ops. `candidates`: the fastest first.
/// Returns the number of fused nodes.
template <class Primitive, class Operation>
std::size_t add_layer(Builder& builder, const Node& node, std::span<const Node> tail,
                      const Layer& layer, const Shape& result,
                      const std::vector<Candidate<Operation>>& candidates) {
  const Value input = builder.operand(node, 0);
  const memory::desc bias_desc = layer.bias_desc();
  std::vector<PostOp> post = post_ops(builder, tail, node.outputs[0], result);
  const auto chosen = choose<typename Primitive::primitive_desc>(builder, candidates, post);
  if (!chosen.get(true)) refuse(node, "is not supported by oneDNN");

  const ResultPlace place = place_result(builder, post, chosen.dst_desc());
  std::vector<Argument> arguments{
      {DNNL_ARG_SRC, builder.in_layout(input, chosen.src_desc())},
      {DNNL_ARG_WEIGHTS, builder.weights(layer.weights, layer.given, chosen.weights_desc())},
      {DNNL_ARG_BIAS, builder.weights(layer.bias, bias_desc, bias_desc)},
      {DNNL_ARG_DST, place.output}};
  arguments.insert(arguments.end(), place.arguments.begin(), place.arguments.end());
  builder.program().add_step(Primitive(chosen), arguments, chosen.scratchpad_desc());
  builder.count_multiplications(static_cast<double>(layer.weights.size()) *
                                static_cast<double>(layer.positions));
  builder.define(output_of(node, tail, post.size()), place.output);
  return post.size();
}

std::vector<float> bias_of(const Builder& builder, const Node& node, std::int64_t channels) {
  const onnx::Tensor* bias = builder.constant(node, 2);
  if (!bias) return std::vector<float>(static_cast<std::size_t>(channels), 0.f);
  if (static_cast<std::int64_t>(bias->floats.size()) != channels)
    refuse(node, "has a bias of another size than its result's channels");
  return bias->floats;
}

const onnx::Tensor& weights_of(const Builder& builder, const Node& node) {
  const onnx::Tensor* weights = builder.constant(node, 1);
  if (!weights || weights->floats.empty()) refuse(node, "has no weights");
  return *weights;
}

[[noreturn]] void refuse_weights(const Node& node, const onnx::Tensor& weights,
                                 const Shape& input) {
  refuse(node, fmt::format("has weights of {} for an input of {}", onnx::to_string(weights.shape),
                           onnx::to_string(input)));
}

/// [groups, results per group, inputs per group, kernel...]; without the first if there is one
/// group.
Shape grouped(std::int64_t groups, std::int64_t results, std::int64_t inputs, const Shape& kernel) {
  Shape shape = image_shape(results, inputs, kernel);
  if (groups > 1) shape.insert(shape.begin(), groups);
  return shape;
}

/// For one channel per group, another implementation than oneDNN 2.6's first one: it makes
/// MediaPipe's palm network a tenth faster.
constexpr std::string_view kDepthwise = "jit_dw";

std::vector<Candidate<dnnl::convolution_forward::desc>> conv_candidates(Builder& builder,
                                                                        const Node& node,
                                                                        const Window& window,
                                                                        const Layer& layer,
                                                                        const Shape& result) {
  const memory::desc input = any_desc(Builder::shape_of(builder.operand(node, 0)));
  const dnnl::convolution_forward::desc operation(
      prop_kind::forward_inference, dnnl::algorithm::convolution_direct, input,
      layer.weights_desc(), layer.bias_desc(), any_desc(result), window.strides, window.gaps(),
      window.before, window.after);
  if (node.integer("group", 1) == result[1]) return {{operation, kDepthwise}, {operation}};
  return {{operation}};
}

std::size_t emit_conv(Builder& builder, const Node& node, std::span<const Node> tail) {
  const onnx::Tensor& weights = weights_of(builder, node);
  const Shape input = builder.operand(node, 0).desc.dims();
  const std::int64_t groups = node.integer("group", 1);
  if (weights.shape.size() != input.size() || input.size() < 3 || groups < 1 ||
      weights.shape[0] % groups != 0 || weights.shape[1] > input[1] ||
      weights.shape[1] * groups != input[1])
    refuse_weights(node, weights, input);
  const std::int64_t channels = weights.shape[0];
  Window window = window_of(node, input, spatial(weights.shape));
  const Shape result = image_shape(input[0], channels, extents_after(node, window, input));
  const Layer layer{weights.floats,
                    plain_desc(grouped(groups, channels / groups, weights.shape[1], window.kernel)),
                    bias_of(builder, node, channels), positions_of(result)};
  return add_layer<dnnl::convolution_forward>(
      builder, node, tail, layer, result, conv_candidates(builder, node, window, layer, result));
}

/// The extents of a transposed convolution's result: those from which a convolution with the same
/// window computes the input.
Shape extents_before(const Node& node, const Window& window, const Shape& input) {
  const Shape extra = node.integers("output_padding", {});
  const bool none_extra =
      std::all_of(extra.begin(), extra.end(), [](std::int64_t rows) { return rows == 0; });
  if (node.has("output_shape") || !none_extra)
    refuse(node, "has output_shape or output_padding, which is not supported");
  Shape extents;
  for (std::size_t i = 0; i < window.kernel.size(); ++i) {
    const std::int64_t reach = window.dilations[i] * (window.kernel[i] - 1) + 1;
    extents.push_back((input[i + 2] - 1) * window.strides[i] + reach - window.before[i] -
                      window.after[i]);
    if (extents.back() < 1) refuse(node, "has an empty result");
  }
  return extents;
}

/// The weights of a grouped transposed convolution as those of a single group, with zeros between
/// the groups: oneDNN is slow with groups (0.8 ms for 48 channels of 12x12; this takes
/// microseconds).
std::vector<float> ungrouped(const onnx::Tensor& weights, std::int64_t groups) {
  const std::int64_t inputs = weights.shape[0], results = weights.shape[1],
                     kernel = onnx::elements(spatial(weights.shape));
  std::vector<float> dense(static_cast<std::size_t>(inputs * results * groups * kernel), 0.f);
  for (std::int64_t i = 0; i < inputs; ++i) {
    const std::int64_t group = i / (inputs / groups);
    const auto from = weights.floats.begin() + i * results * kernel;
    std::copy(from, from + results * kernel,
              dense.begin() + (i * groups + group) * results * kernel);
  }
  return dense;
}

std::size_t emit_conv_transpose(Builder& builder, const Node& node, std::span<const Node> tail) {
  const onnx::Tensor& weights = weights_of(builder, node);
  const Shape input = builder.operand(node, 0).desc.dims();
  const std::int64_t groups = node.integer("group", 1);
  if (weights.shape.size() != input.size() || input.size() < 3 || groups < 1 ||
      weights.shape[0] != input[1] || input[1] % groups != 0)
    refuse_weights(node, weights, input);
  if (onnx::elements({groups, weights.shape[1]}) == 0) refuse_weights(node, weights, input);
  const std::int64_t results = weights.shape[1] * groups;
  const Window window = window_of(node, input, spatial(weights.shape));
  const Shape result = image_shape(input[0], results, extents_before(node, window, input));
  // ONNX has the input channels first, oneDNN the result channels.
  const memory::desc in_file = plain_desc(image_shape(input[1], results, window.kernel));
  std::vector<int> swap(in_file.dims().size());
  std::iota(swap.begin(), swap.end(), 0);
  std::swap(swap[0], swap[1]);
  const std::vector<float> dense = ungrouped(weights, groups);
  const Layer layer{dense, in_file.permute_axes(swap), bias_of(builder, node, results),
                    positions_of(input)};
  const dnnl::deconvolution_forward::desc operation(
      prop_kind::forward_inference, dnnl::algorithm::deconvolution_direct, any_desc(input),
      layer.weights_desc(), layer.bias_desc(), any_desc(result), window.strides, window.gaps(),
      window.before, window.after);
  return add_layer<dnnl::deconvolution_forward>(builder, node, tail, layer, result,
                                                only_candidate(operation));
}

std::vector<float> scaled(std::vector<float> numbers, float factor) {
  for (float& number : numbers) number *= factor;
  return numbers;
}

std::size_t emit_gemm(Builder& builder, const Node& node, std::span<const Node> tail) {
  const onnx::Tensor& weights = weights_of(builder, node);
  const Shape input = builder.operand(node, 0).desc.dims();
  const bool transposed = node.integer("transB", 0) != 0;
  if (node.integer("transA", 0) != 0) refuse(node, "transposes its input, which is not supported");
  if (input.size() != 2 || weights.shape.size() != 2 ||
      weights.shape[transposed ? 1 : 0] != input[1])
    refuse_weights(node, weights, input);
  const std::int64_t results = weights.shape[transposed ? 0 : 1];
  const memory::desc in_file = plain_desc(weights.shape);
  const std::vector<float> numbers = scaled(weights.floats, node.number("alpha", 1));
  const Layer layer{numbers, transposed ? in_file : in_file.permute_axes({1, 0}),
                    scaled(bias_of(builder, node, results), node.number("beta", 1)), input[0]};
  const Shape result{input[0], results};
  const dnnl::inner_product_forward::desc operation(prop_kind::forward_inference, any_desc(input),
                                                    layer.weights_desc(), layer.bias_desc(),
                                                    any_desc(result));
  return add_layer<dnnl::inner_product_forward>(builder, node, tail, layer, result,
                                                only_candidate(operation));
}

constexpr Operator kConvolutionOperators[] = {
    {"Conv", emit_conv}, {"ConvTranspose", emit_conv_transpose}, {"Gemm", emit_gemm}};

}  // namespace

std::span<const Operator> convolution_operators() { return kConvolutionOperators; }

}  // namespace handcast::landmarks::onednn
