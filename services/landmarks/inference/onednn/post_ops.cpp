// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/inference/onednn/post_ops.hpp"

#include <functional>
#include <limits>
#include <utility>

namespace handcast::landmarks::onednn {

using dnnl::algorithm;

namespace {

/// The bounds of a Clip are attributes up to operator set 10, inputs since 11.
Activation clip(const Builder& builder, const Node& node) {
  const auto bound = [&](const char* attribute, std::size_t input, float otherwise) {
    const onnx::Tensor* tensor = builder.constant(node, input);
    if (!tensor) return node.number(attribute, otherwise);
    if (tensor->floats.size() != 1) refuse(node, "has a bound that is not a single number");
    return tensor->floats[0];
  };
  return {algorithm::eltwise_clip, bound("min", 1, std::numeric_limits<float>::lowest()),
          bound("max", 2, std::numeric_limits<float>::max())};
}

using MakeActivation = std::function<Activation(const Builder&, const Node&)>;

MakeActivation fixed(Activation activation) {
  return [activation](const Builder&, const Node&) { return activation; };
}

const std::map<std::string, MakeActivation>& activations() {
  static const std::map<std::string, MakeActivation> table{
      {"Relu", fixed({algorithm::eltwise_relu})},
      {"Sigmoid", fixed({algorithm::eltwise_logistic})},
      {"Tanh", fixed({algorithm::eltwise_tanh})},
      {"Exp", fixed({algorithm::eltwise_exp})},
      {"Log", fixed({algorithm::eltwise_log})},
      {"Sqrt", fixed({algorithm::eltwise_sqrt})},
      {"Abs", fixed({algorithm::eltwise_abs})},
      {"Neg", fixed({algorithm::eltwise_linear, -1})},
      {"Reciprocal", fixed({algorithm::eltwise_pow, 1, -1})},
      {"Softplus", fixed({algorithm::eltwise_soft_relu})},
      {"HardSwish", fixed({algorithm::eltwise_hardswish})},
      {"Clip", clip},
      {"LeakyRelu",
       [](const Builder&, const Node& node) {
         return Activation{algorithm::eltwise_relu, node.number("alpha", 0.01f)};
       }},
      {"Elu",
       [](const Builder&, const Node& node) {
         return Activation{algorithm::eltwise_elu, node.number("alpha", 1)};
       }},
  };
  return table;
}

/// The other operand of an addition to `result`; empty if it cannot be broadcast to it.
std::optional<PostOp> addition(Builder& builder, const Node& node, const std::string& result,
                               const Shape& shape) {
  const Value other = builder.operand(node, node.inputs[0] == result ? 1 : 0);
  const Shape added = Builder::shape_of(other);
  if (added == shape) return PostOp{PostOp::kSum, other, {}};
  const bool is_plain = other.desc == plain_desc(added);
  if (added.size() > shape.size() || !is_plain ||
      !broadcasts_to(widened(added, shape.size()), shape))
    return std::nullopt;
  return PostOp{
      PostOp::kBroadcastAdd, {plain_desc(widened(added, shape.size())), other.buffer}, {}};
}

/// A PRelu with one slope per channel; empty if it has others.
std::optional<PostOp> prelu(Builder& builder, const Node& node, const Shape& shape) {
  const onnx::Tensor* tensor = builder.constant(node, 1);
  if (!tensor || shape.size() < 2 || static_cast<std::int64_t>(tensor->floats.size()) != shape[1])
    return std::nullopt;
  if (!broadcasts_to(widened(tensor->shape, shape.size()), shape)) return std::nullopt;
  Shape per_channel(shape.size(), 1);
  per_channel[1] = shape[1];
  const auto desc = plain_desc(per_channel);
  return PostOp{PostOp::kPrelu, builder.weights(tensor->floats, desc, desc), {}};
}

}  // namespace

std::optional<Activation> activation_of(const Builder& builder, const Node& node) {
  const auto found = activations().find(node.op);
  if (found == activations().end()) return std::nullopt;
  return found->second(builder, node);
}

Shape widened(const Shape& shape, std::size_t rank) {
  Shape result(rank > shape.size() ? rank - shape.size() : 0, 1);
  result.insert(result.end(), shape.begin(), shape.end());
  return result;
}

bool broadcasts_to(const Shape& from, const Shape& to) {
  if (from.size() != to.size()) return false;
  for (std::size_t i = 0; i < from.size(); ++i)
    if (from[i] != to[i] && from[i] != 1) return false;
  return true;
}

std::vector<PostOp> post_ops(Builder& builder, std::span<const Node> tail,
                             const std::string& result, const Shape& shape) {
  std::vector<PostOp> ops;
  bool has_sum = false;
  std::string name = result;
  for (const Node& node : tail) {
    std::optional<PostOp> op;
    if (node.op == "Add") {
      op = addition(builder, node, name, shape);
    } else if (node.op == "PRelu") {
      op = prelu(builder, node, shape);
    } else if (const auto activation = activation_of(builder, node)) {
      op = PostOp{PostOp::kActivation, {}, *activation};
    }
    if (!op || (op->kind == PostOp::kSum && std::exchange(has_sum, true))) break;
    ops.push_back(*op);
    name = node.outputs[0];
  }
  return ops;
}

dnnl::primitive_attr attributes_with(std::span<const PostOp> ops) {
  dnnl::post_ops list;
  for (const PostOp& op : ops) {
    switch (op.kind) {
      case PostOp::kSum:
        list.append_sum();
        break;
      case PostOp::kBroadcastAdd:
        list.append_binary(algorithm::binary_add, op.other.desc);
        break;
      case PostOp::kPrelu:
        list.append_prelu(1 << 1);
        break;
      case PostOp::kActivation:
        list.append_eltwise(1, op.activation.algorithm, op.activation.alpha, op.activation.beta);
        break;
    }
  }
  dnnl::primitive_attr attributes = own_scratchpad();
  attributes.set_post_ops(list);
  return attributes;
}

ResultPlace place_result(Builder& builder, std::span<const PostOp> ops,
                         const dnnl::memory::desc& desc) {
  ResultPlace place;
  for (int i = 0; i < static_cast<int>(ops.size()); ++i) {
    const int role = DNNL_ARG_ATTR_MULTIPLE_POST_OP(i);
    if (ops[i].kind == PostOp::kSum) place.output = builder.to_overwrite(ops[i].other, desc);
    if (ops[i].kind == PostOp::kBroadcastAdd)
      place.arguments.push_back({role | DNNL_ARG_SRC_1, ops[i].other});
    if (ops[i].kind == PostOp::kPrelu)
      place.arguments.push_back({role | DNNL_ARG_WEIGHTS, ops[i].other});
  }
  if (place.output.buffer < 0) place.output = builder.make(desc);
  return place;
}

}  // namespace handcast::landmarks::onednn
