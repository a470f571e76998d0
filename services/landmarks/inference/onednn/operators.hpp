// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>

#include "services/landmarks/inference/onednn/builder.hpp"

namespace handcast::landmarks::onednn {

/// Adds the steps of a node and defines its outputs. `tail`: the nodes that may be fused with it.
/// Returns how many of them were fused; the last of these names the output.
using Emit = std::size_t (*)(Builder& builder, const Node& node, std::span<const Node> tail);

/// A row of the tables of operators.
struct Operator {
  const char* name;  ///< in ONNX
  Emit emit;         ///< adds its steps
};

/// Layers with weights: convolution.cpp.
std::span<const Operator> convolution_operators();
/// Windows without weights: pooling.cpp.
std::span<const Operator> pooling_operators();
/// Elementwise operators, reductions, products: arithmetic.cpp.
std::span<const Operator> arithmetic_operators();
/// Operators that rearrange elements: layout.cpp.
std::span<const Operator> layout_operators();

/// The name of the result of a node fused with the first `taken` nodes of its tail.
const std::string& output_of(const Node& node, std::span<const Node> tail, std::size_t taken);

/// Adds the steps of a node by its row in the tables. Returns the number of fused nodes, as Emit.
/// Throws Refused if the tables do not have its operator.
std::size_t emit(Builder& builder, const Node& node, std::span<const Node> tail);

}  // namespace handcast::landmarks::onednn
