// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "services/landmarks/inference/onednn/builder.hpp"

namespace handcast::landmarks::onednn {

/// An elementwise function: y = algorithm(x; alpha, beta).
struct Activation {
  dnnl::algorithm algorithm = dnnl::algorithm::undef;  ///< oneDNN's function
  /// Its parameters.
  /// @{
  float alpha = 0, beta = 0;
  /// @}
};

/// The elementwise function of a node; empty if it is another kind of node.
std::optional<Activation> activation_of(const Builder& builder, const Node& node);

/// A node that a primitive applies to its result before writing it.
struct PostOp {
  /// The operation: kSum adds a value of the same shape in place, kBroadcastAdd another value.
  enum Kind { kSum, kBroadcastAdd, kPrelu, kActivation };
  Kind kind;  ///< the operation
  /// The second operand. kSum: in the memory of the result; kPrelu: the slopes.
  Value other;
  Activation activation;  ///< the function of kActivation
};

/// The nodes of `tail` that can be applied to the value `result` of this shape.
std::vector<PostOp> post_ops(Builder& builder, std::span<const Node> tail,
                             const std::string& result, const Shape& shape);

/// Attributes of a primitive that applies `ops`.
dnnl::primitive_attr attributes_with(std::span<const PostOp> ops);

/// The memory of a result and the arguments of its post-ops.
struct ResultPlace {
  Value output;                     ///< the result
  std::vector<Argument> arguments;  ///< the operands of the post-ops
};

/// Allocates a result of layout `desc`. With a kSum, it overwrites the second operand or a copy.
ResultPlace place_result(Builder& builder, std::span<const PostOp> ops,
                         const dnnl::memory::desc& desc);

/// `shape` with extents of 1 in front, so that it has `rank` axes.
Shape widened(const Shape& shape, std::size_t rank);
/// True if each extent of `from` is that of `to` or 1.
bool broadcasts_to(const Shape& from, const Shape& to);

}  // namespace handcast::landmarks::onednn
