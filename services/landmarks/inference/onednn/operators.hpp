// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>

#include "services/landmarks/inference/onednn/builder.hpp"

namespace handcast::landmarks::onednn {

/// Adds the steps of a node and defines its outputs. `tail`: the nodes that may run with it;
/// returns how many it took along, the last of which names the output.
using Emit = std::size_t (*)(Builder& builder, const Node& node, std::span<const Node> tail);

struct Operator {
  const char* name;
  Emit emit;
};

std::span<const Operator> convolution_operators();
std::span<const Operator> pooling_operators();
std::span<const Operator> arithmetic_operators();
std::span<const Operator> layout_operators();

/// The name of what a node makes together with the first `taken` of its tail.
const std::string& output_of(const Node& node, std::span<const Node> tail, std::size_t taken);

/// Runs a node; refuses an operator that none of the tables has.
std::size_t emit(Builder& builder, const Node& node, std::span<const Node> tail);

}  // namespace handcast::landmarks::onednn
