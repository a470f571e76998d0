// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <set>

#include "tests/services/landmarks/inference/opencv_network.hpp"

namespace handcast::landmarks::onnx {

namespace {

Attribute number(float value) {
  Attribute attribute{.kind = Attribute::kNumber};
  attribute.number = value;
  return attribute;
}

Attribute integer(std::int64_t value) {
  Attribute attribute{.kind = Attribute::kInteger};
  attribute.integer = value;
  return attribute;
}

const Tensor* constant(const Model& model, const Node& node, std::size_t input) {
  if (!node.has_input(input)) return nullptr;
  const auto found = model.constants.find(node.inputs[input]);
  return found == model.constants.end() ? nullptr : &found->second;
}

/// Moves the bounds of a Clip to attributes. A bound that is not a constant stays an input, which
/// OpenCV refuses.
void bounds_to_attributes(const Model& model, Node& node) {
  const auto is_known = [&](std::size_t input) {
    const Tensor* bound = constant(model, node, input);
    return !node.has_input(input) || (bound && bound->floats.size() == 1);
  };
  if (!is_known(1) || !is_known(2)) return;
  const auto move = [&](std::size_t input, const char* name, float otherwise) {
    const Tensor* bound = constant(model, node, input);
    if (!node.has(name)) node.attributes[name] = number(bound ? bound->floats[0] : otherwise);
  };
  move(1, "min", std::numeric_limits<float>::lowest());
  move(2, "max", std::numeric_limits<float>::max());
  node.inputs.resize(1);
}

/// Replaces a Squeeze of [1,c,1,1] to [1,c], the usual one after global pooling.
void squeeze_to_flatten(const Model& model, Node& node) {
  const Tensor* axes = constant(model, node, 1);
  if (!axes || axes->integers != std::vector<std::int64_t>{2, 3}) return;
  node.op = "Flatten";
  node.inputs.resize(1);
  node.attributes = {{"axis", integer(1)}};
}

Tensor transposed(const Tensor& weights) {
  const auto rows = static_cast<std::size_t>(weights.shape[0]),
             columns = static_cast<std::size_t>(weights.shape[1]);
  Tensor result{.shape = {weights.shape[1], weights.shape[0]},
                .floats = std::vector<float>(weights.floats.size())};
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column)
      result.floats[column * rows + row] = weights.floats[row * columns + column];
  return result;
}

void transpose_weights(Model& model, Node& node) {
  const Tensor* weights = constant(model, node, 1);
  if (node.integer("transB", 0) != 0 || !weights || weights->shape.size() != 2 ||
      weights->floats.empty())
    return;
  const std::string name = node.inputs[1] + " transposed";
  model.constants[name] = transposed(*weights);
  node.inputs[1] = name;
  node.attributes["transB"] = integer(1);
}

void drop_unused_constants(Model& model) {
  std::set<std::string> used;
  for (const Node& node : model.nodes) used.insert(node.inputs.begin(), node.inputs.end());
  std::erase_if(model.constants, [&](const auto& entry) { return !used.contains(entry.first); });
}

}  // namespace

void adapt_for_opencv(Model& model) {
  for (Node& node : model.nodes) {
    if (node.op == "Clip") bounds_to_attributes(model, node);
    if (node.op == "Squeeze") squeeze_to_flatten(model, node);
    if (node.op == "Gemm") transpose_weights(model, node);
  }
  drop_unused_constants(model);
}

}  // namespace handcast::landmarks::onnx
