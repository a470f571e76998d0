// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "services/landmarks/inference/onednn/builder.hpp"

namespace handcast::landmarks::onednn {

/// An elementwise function: y = algorithm(x; alpha, beta).
struct Activation {
  dnnl::algorithm algorithm = dnnl::algorithm::undef;
  float alpha = 0, beta = 0;
};

/// The elementwise function of a node; nothing if it is another kind of node.
std::optional<Activation> activation_of(const Builder& builder, const Node& node);

/// A node that a primitive applies to its result before writing it.
struct PostOp {
  enum Kind { kSum, kBroadcastAdd, kPrelu, kActivation } kind;
  /// kSum: what is added, in the memory of the result; kBroadcastAdd: what is added; kPrelu: the
  /// slopes.
  Value other;
  Activation activation;
};

/// The nodes of `tail` that can be applied to the value `result` of this shape.
std::vector<PostOp> post_ops(Builder& builder, std::span<const Node> tail,
                             const std::string& result, const Shape& shape);

/// Attributes of a primitive that applies `ops`.
dnnl::primitive_attr attributes_with(std::span<const PostOp> ops);

/// The memory of a result and the arguments of its post-ops.
struct ResultPlace {
  Value output;
  std::vector<Argument> arguments;
};
/// With a kSum, the result overwrites what is added, or a copy of it.
ResultPlace place_result(Builder& builder, std::span<const PostOp> ops,
                         const dnnl::memory::desc& desc);

/// `shape` with extents of 1 in front, so that it has `rank` axes.
Shape widened(const Shape& shape, std::size_t rank);
/// Whether each extent of `from` is that of `to` or 1.
bool broadcasts_to(const Shape& from, const Shape& to);

}  // namespace handcast::landmarks::onednn
