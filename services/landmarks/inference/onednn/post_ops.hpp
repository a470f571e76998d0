// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "services/landmarks/inference/onednn/builder.hpp"

namespace handcast::landmarks::onednn {

/// y = algorithm(x; alpha, beta) of each number.
struct Bend {
  dnnl::algorithm algorithm = dnnl::algorithm::undef;
  float alpha = 0, beta = 0;
};

/// What a node does to each number alone; nothing where it is no such node.
std::optional<Bend> bend_of(const Builder& builder, const Node& node);

/// One node that a primitive does to its result before it writes it.
struct PostOp {
  enum Kind { kSum, kSpreadAdd, kPrelu, kBend } kind;
  Value other;  ///< kSum: what lies where the result will lie; kSpreadAdd: what is added to it;
                ///< kPrelu: the slopes
  Bend bend;
};

/// What of `tail` can follow the value `result` of the given shape so.
std::vector<PostOp> post_ops(Builder& builder, std::span<const Node> tail,
                             const std::string& result, const Shape& shape);

dnnl::primitive_attr attributes_with(std::span<const PostOp> ops);

/// The result's place and the arguments that the operations need: with a sum, the result overwrites
/// (a copy of) what is added.
struct Landing {
  Value output;
  std::vector<Argument> arguments;
};
Landing land(Builder& builder, std::span<const PostOp> ops, const dnnl::memory::desc& desc);

/// `shape` with extents of 1 in front, up to `rank`.
Shape widened(const Shape& shape, std::size_t rank);
/// Whether each extent of `from` is that of `to`, or 1.
bool spreads_over(const Shape& from, const Shape& to);

}  // namespace handcast::landmarks::onednn
