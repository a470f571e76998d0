// SPDX-License-Identifier: Apache-2.0
// Sums and products of two values, functions of one number, PRelu, Softmax, reductions, MatMul.
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

/// oneDNN spreads the second operand only: the larger one comes first, where the order does not
/// matter.
std::pair<Value, Value> operands(Builder& builder, const Node& node) {
  if (node.inputs.size() != 2) refuse(node, "has not two operands");
  Value a = builder.operand(node, 0), b = builder.operand(node, 1);
  const std::size_t rank = std::max(a.desc.dims().size(), b.desc.dims().size());
  a = with_rank(builder, a, rank);
  b = with_rank(builder, b, rank);
  const bool commutes = node.op != "Sub" && node.op != "Div";
  if (commutes && !spreads_over(b.desc.dims(), a.desc.dims())) std::swap(a, b);
  if (!spreads_over(b.desc.dims(), a.desc.dims()))
    refuse(node, fmt::format("combines {} and {}, which is not supported",
                             onnx::to_string(a.desc.dims()), onnx::to_string(b.desc.dims())));
  if (a.desc.dims() == b.desc.dims()) b = builder.in_layout(b, a.desc);
  return {a, b};
}

std::size_t emit_binary(Builder& builder, const Node& node, std::span<const Node> tail) {
  const auto [a, b] = operands(builder, node);
  std::vector<PostOp> post = post_ops(builder, tail, node.outputs[0], a.desc.dims());
  // A sum as a post-op would have to lie where the result lies; only activations are taken along.
  const auto unfit = std::find_if(post.begin(), post.end(),
                                  [](const PostOp& op) { return op.kind != PostOp::kBend; });
  post.erase(unfit, post.end());
  const dnnl::binary::primitive_desc chosen({binary_of(node), a.desc, b.desc, a.desc},
                                            attributes_with(post), builder.engine());
  const Value output = builder.make(a.desc);
  builder.program().add_step(dnnl::binary(chosen),
                             {{DNNL_ARG_SRC_0, a}, {DNNL_ARG_SRC_1, b}, {DNNL_ARG_DST, output}},
                             chosen.scratchpad_desc());
  builder.define(output_of(node, tail, post.size()), output);
  return post.size();
}

std::size_t emit_bend(Builder& builder, const Node& node, std::span<const Node>) {
  const Value input = builder.operand(node, 0);
  const Bend bend = *bend_of(builder, node);
  const dnnl::eltwise_forward::desc operation(prop_kind::forward_inference, bend.algorithm,
                                              input.desc, bend.alpha, bend.beta);
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
      !spreads_over(widened(slopes->shape, shape.size()), shape))
    refuse(node, "has slopes that do not fit");
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
  // Until operator set 12 every axis from this one on was meant: the same where it is the last.
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

constexpr Operator kOperators[] = {
    {"Add", emit_binary},       {"Sub", emit_binary},       {"Mul", emit_binary},
    {"Div", emit_binary},       {"Max", emit_binary},       {"Min", emit_binary},
    {"Relu", emit_bend},        {"Sigmoid", emit_bend},     {"Tanh", emit_bend},
    {"Exp", emit_bend},         {"Log", emit_bend},         {"Sqrt", emit_bend},
    {"Abs", emit_bend},         {"Neg", emit_bend},         {"Reciprocal", emit_bend},
    {"Softplus", emit_bend},    {"HardSwish", emit_bend},   {"Clip", emit_bend},
    {"LeakyRelu", emit_bend},   {"Elu", emit_bend},         {"PRelu", emit_prelu},
    {"Softmax", emit_softmax},  {"ReduceSum", emit_reduce}, {"ReduceMean", emit_reduce},
    {"ReduceMax", emit_reduce}, {"ReduceMin", emit_reduce}, {"MatMul", emit_matmul},
};

}  // namespace

std::span<const Operator> arithmetic_operators() { return kOperators; }

}  // namespace handcast::landmarks::onednn
