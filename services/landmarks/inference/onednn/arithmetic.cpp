// SPDX-License-Identifier: Apache-2.0
// Elementwise operators of one and two values, PRelu, Softmax, reductions, MatMul.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "services/landmarks/inference/onednn/operators.hpp"
#include "services/landmarks/inference/onednn/post_ops.hpp"

namespace handcast::landmarks::onednn {

namespace {

using dnnl::algorithm;
using dnnl::memory;
using dnnl::prop_kind;

algorithm binary_of(const Node& node) {
  if (node.op == "Add") return algorithm::binary_add;
  if (node.op == "Sub") return algorithm::binary_sub;
  if (node.op == "Mul") return algorithm::binary_mul;
  if (node.op == "Div") return algorithm::binary_div;
  return node.op == "Max" ? algorithm::binary_max : algorithm::binary_min;
}

Value with_rank(Builder& builder, const Value& value, std::size_t rank) {
  const Shape shape = Builder::shape_of(value);
  if (shape.size() == rank) return value;
  return {plain_desc(widened(shape, rank)), builder.plain(value).buffer};
}

/// oneDNN broadcasts the second operand only. If the operator commutes, the larger operand becomes
/// the first.
std::pair<Value, Value> operands(Builder& builder, const Node& node) {
  if (node.inputs.size() != 2) refuse(node, "does not have two operands");
  Value a = builder.operand(node, 0), b = builder.operand(node, 1);
  const std::size_t rank = std::max(a.desc.dims().size(), b.desc.dims().size());
  a = with_rank(builder, a, rank);
  b = with_rank(builder, b, rank);
  const bool commutes = node.op != "Sub" && node.op != "Div";
  if (commutes && !broadcasts_to(b.desc.dims(), a.desc.dims())) std::swap(a, b);
  if (!broadcasts_to(b.desc.dims(), a.desc.dims()))
    refuse(node, fmt::format("combines {} and {}, which is not supported",
                             onnx::to_string(a.desc.dims()), onnx::to_string(b.desc.dims())));
  if (a.desc.dims() == b.desc.dims()) b = builder.in_layout(b, a.desc);
  return {a, b};
}

std::size_t emit_binary(Builder& builder, const Node& node, std::span<const Node> tail) {
  const auto [a, b] = operands(builder, node);
  std::vector<PostOp> post = post_ops(builder, tail, node.outputs[0], a.desc.dims());
  // A sum as a post-op would have to share the memory of the result; only activations are fused.
  const auto end_of_activations = std::find_if(
      post.begin(), post.end(), [](const PostOp& op) { return op.kind != PostOp::kActivation; });
  post.erase(end_of_activations, post.end());
  const dnnl::binary::primitive_desc chosen({binary_of(node), a.desc, b.desc, a.desc},
                                            attributes_with(post), builder.engine());
  const Value output = builder.make(a.desc);
  builder.program().add_step(dnnl::binary(chosen),
                             {{DNNL_ARG_SRC_0, a}, {DNNL_ARG_SRC_1, b}, {DNNL_ARG_DST, output}},
                             chosen.scratchpad_desc());
  builder.define(output_of(node, tail, post.size()), output);
  return post.size();
}

std::size_t emit_activation(Builder& builder, const Node& node, std::span<const Node>) {
  const Value input = builder.operand(node, 0);
  const Activation activation = *activation_of(builder, node);
  const dnnl::eltwise_forward::desc operation(prop_kind::forward_inference, activation.algorithm,
                                              input.desc, activation.alpha, activation.beta);
  const dnnl::eltwise_forward::primitive_desc chosen(operation, own_scratchpad(), builder.engine());
  const Value output = builder.make_over(input);
  builder.program().add_step(dnnl::eltwise_forward(chosen),
                             {{DNNL_ARG_SRC, input}, {DNNL_ARG_DST, output}},
                             chosen.scratchpad_desc());
  builder.define(node.outputs[0], output);
  return 0;
}

std::size_t emit_prelu(Builder& builder, const Node& node, std::span<const Node>) {
  const Value input = builder.operand(node, 0);
  const onnx::Tensor* slopes = builder.constant(node, 1);
  const Shape shape = input.desc.dims();
  if (!slopes || slopes->floats.empty() ||
      !broadcasts_to(widened(slopes->shape, shape.size()), shape))
    refuse(node, "has slopes that cannot be broadcast to its input");
  const memory::desc given = plain_desc(widened(slopes->shape, shape.size()));
  const dnnl::prelu_forward::desc operation(prop_kind::forward_inference, input.desc,
                                            any_desc(given.dims()));
  const dnnl::prelu_forward::primitive_desc chosen(operation, own_scratchpad(), builder.engine());
  const Value output = builder.make_over(input);
  const Value weights = builder.weights(slopes->floats, given, chosen.weights_desc());
  builder.program().add_step(
      dnnl::prelu_forward(chosen),
      {{DNNL_ARG_SRC, input}, {DNNL_ARG_WEIGHTS, weights}, {DNNL_ARG_DST, output}},
      chosen.scratchpad_desc());
  builder.define(node.outputs[0], output);
  return 0;
}

std::int64_t axis_of(const Node& node, std::int64_t axis, std::size_t rank) {
  const auto count = static_cast<std::int64_t>(rank);
  if (axis < -count || axis >= count) refuse(node, fmt::format("names axis {} of {}", axis, rank));
  return axis < 0 ? axis + count : axis;
}

std::size_t emit_softmax(Builder& builder, const Node& node, std::span<const Node>) {
  const Value input = builder.plain(builder.operand(node, 0));
  const std::size_t rank = input.desc.dims().size();
  const std::int64_t axis = axis_of(node, node.integer("axis", -1), rank);
  // Up to operator set 12 a Softmax is over all axes from this one on: the same if it is the last.
  if (axis + 1 != static_cast<std::int64_t>(rank)) refuse(node, "is not over the last axis");
  const dnnl::softmax_forward::desc operation(prop_kind::forward_inference, input.desc,
                                              static_cast<int>(axis));
  const dnnl::softmax_forward::primitive_desc chosen(operation, own_scratchpad(), builder.engine());
  const Value output = builder.make(chosen.dst_desc());
  builder.program().add_step(dnnl::softmax_forward(chosen),
                             {{DNNL_ARG_SRC, input}, {DNNL_ARG_DST, output}},
                             chosen.scratchpad_desc());
  builder.define(node.outputs[0], output);
  return 0;
}

algorithm reduction_of(const Node& node) {
  if (node.op == "ReduceSum") return algorithm::reduction_sum;
  if (node.op == "ReduceMean") return algorithm::reduction_mean;
  return node.op == "ReduceMax" ? algorithm::reduction_max : algorithm::reduction_min;
}

std::size_t emit_reduce(Builder& builder, const Node& node, std::span<const Node>) {
  const Value input = builder.plain(builder.operand(node, 0));
  const Shape shape = input.desc.dims();
  Shape all(shape.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::int64_t>(i);
  Shape axes =
      node.has("axes") ? node.integers("axes", {}) : builder.integers(node, 1).value_or(all);
  Shape result = shape, kept;
  for (const std::int64_t axis : axes) result[axis_of(node, axis, shape.size())] = 1;
  std::vector<bool> gone(shape.size(), false);
  for (const std::int64_t axis : axes) gone[axis_of(node, axis, shape.size())] = true;
  for (std::size_t i = 0; i < shape.size(); ++i)
    if (!gone[i]) kept.push_back(shape[i]);
  Value output = input;
  if (result != shape) {
    const dnnl::reduction::desc operation(reduction_of(node), input.desc, plain_desc(result), 0, 0);
    const dnnl::reduction::primitive_desc chosen(operation, own_scratchpad(), builder.engine());
    output = builder.make(chosen.dst_desc());
    builder.program().add_step(dnnl::reduction(chosen),
                               {{DNNL_ARG_SRC, input}, {DNNL_ARG_DST, output}},
                               chosen.scratchpad_desc());
  }
  if (node.integer("keepdims", 1) == 0) output.desc = plain_desc(kept.empty() ? Shape{1} : kept);
  builder.define(node.outputs[0], output);
  return 0;
}

std::size_t emit_matmul(Builder& builder, const Node& node, std::span<const Node>) {
  Value a = builder.plain(builder.operand(node, 0)), b = builder.plain(builder.operand(node, 1));
  const std::size_t rank = std::max(a.desc.dims().size(), b.desc.dims().size());
  if (std::min(a.desc.dims().size(), b.desc.dims().size()) < 2)
    refuse(node, "multiplies a vector, which is not supported");
  a = with_rank(builder, a, rank);
  b = with_rank(builder, b, rank);
  const Shape rows = a.desc.dims(), columns = b.desc.dims();
  Shape result = rows;
  result.back() = columns.back();
  bool fits = rows[rank - 1] == columns[rank - 2];
  for (std::size_t i = 0; i + 2 < rank; ++i) {
    fits = fits && (rows[i] == columns[i] || rows[i] == 1 || columns[i] == 1);
    result[i] = std::max(rows[i], columns[i]);
  }
  if (!fits)
    refuse(node,
           fmt::format("multiplies {} by {}", onnx::to_string(rows), onnx::to_string(columns)));
  const dnnl::matmul::primitive_desc chosen({a.desc, b.desc, plain_desc(result)}, own_scratchpad(),
                                            builder.engine());
  const Value output = builder.make(chosen.dst_desc());
  builder.program().add_step(dnnl::matmul(chosen),
                             {{DNNL_ARG_SRC, a}, {DNNL_ARG_WEIGHTS, b}, {DNNL_ARG_DST, output}},
                             chosen.scratchpad_desc());
  builder.count_multiplications(static_cast<double>(onnx::elements(result)) *
                                static_cast<double>(rows.back()));
  builder.define(node.outputs[0], output);
  return 0;
}

constexpr Operator kArithmeticOperators[] = {
    {"Add", emit_binary},           {"Sub", emit_binary},           {"Mul", emit_binary},
    {"Div", emit_binary},           {"Max", emit_binary},           {"Min", emit_binary},
    {"Relu", emit_activation},      {"Sigmoid", emit_activation},   {"Tanh", emit_activation},
    {"Exp", emit_activation},       {"Log", emit_activation},       {"Sqrt", emit_activation},
    {"Abs", emit_activation},       {"Neg", emit_activation},       {"Reciprocal", emit_activation},
    {"Softplus", emit_activation},  {"HardSwish", emit_activation}, {"Clip", emit_activation},
    {"LeakyRelu", emit_activation}, {"Elu", emit_activation},       {"PRelu", emit_prelu},
    {"Softmax", emit_softmax},      {"ReduceSum", emit_reduce},     {"ReduceMean", emit_reduce},
    {"ReduceMax", emit_reduce},     {"ReduceMin", emit_reduce},     {"MatMul", emit_matmul},
};

}  // namespace

std::span<const Operator> arithmetic_operators() { return kArithmeticOperators; }

}  // namespace handcast::landmarks::onednn
