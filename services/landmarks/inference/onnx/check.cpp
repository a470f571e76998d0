// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "ipc/base/quote.hpp"
#include "services/landmarks/inference/onnx/model.hpp"

namespace handcast::landmarks::onnx {

namespace {

constexpr std::int64_t kOldestOpset = 7, kNewestOpset = 21;
constexpr std::size_t kMostExtents = 6;

/// The sentence may name what the file names.
tl::unexpected<Error> wrong(std::string_view what) {
  constexpr std::size_t kLongest = 400;
  return fail(Errc::bad_config, shown_line(what, kLongest));
}

Result<void> check_port(const Port& port, const char* kind) {
  if (port.shape.size() > kMostExtents || elements(port.shape) == 0)
    return wrong(fmt::format("its {} '{}' is {}; every extent but the batch's must be fixed", kind,
                             port.name, to_string(port.shape)));
  if (port.shape.empty() || port.shape[0] != 1)
    return wrong(fmt::format("its {} '{}' is {}; the first extent, the batch, must be 1", kind,
                             port.name, to_string(port.shape)));
  return {};
}

Result<void> check_constants(const Model& model) {
  for (const auto& [name, tensor] : model.constants) {
    const bool finite = std::all_of(tensor.floats.begin(), tensor.floats.end(),
                                    [](float value) { return std::isfinite(value); });
    if (!finite)
      return wrong(fmt::format("the weights '{}' have values that are not finite", name));
  }
  return {};
}

/// Checks the attributes with which any operator could divide by zero or exhaust the memory.
Result<void> check_attributes(const Node& node) {
  struct Limits {
    const char* attribute;
    std::int64_t least, most;
  };
  for (const auto& [name, least, most] : {Limits{"strides", 1, 4096},
                                          {"dilations", 1, 4096},
                                          {"kernel_shape", 1, 4096},
                                          {"pads", 0, 65536}}) {
    for (const std::int64_t value : node.integers(name, {}))
      if (value < least || value > most)
        return wrong(fmt::format("{} has {} of {}", node.title(), name, value));
  }
  if (const std::int64_t groups = node.integer("group", 1); groups < 1 || groups > 65536)
    return wrong(fmt::format("{} has {} groups", node.title(), groups));
  return {};
}

Result<void> check_nodes(const Model& model) {
  std::set<std::string> known;
  for (const auto& [name, tensor] : model.constants) known.insert(name);
  for (const Port& port : model.inputs)
    if (!known.insert(port.name).second)
      return wrong(fmt::format("'{}' is given twice", port.name));
  for (const Node& node : model.nodes) {
    if (node.outputs.empty()) return wrong(fmt::format("a node ({}) has no outputs", node.op));
    if (auto sound = check_attributes(node); !sound) return sound;
    for (const std::string& input : node.inputs)
      if (!input.empty() && !known.contains(input))
        return wrong(fmt::format(
            "{} needs '{}', which is neither a weight nor an input nor computed by an earlier node",
            node.title(), input));
    for (const std::string& output : node.outputs)
      if (!output.empty() && !known.insert(output).second)
        return wrong(fmt::format("'{}' is computed twice", output));
  }
  for (const Port& port : model.outputs)
    if (!known.contains(port.name))
      return wrong(fmt::format("no node computes its output '{}'", port.name));
  return {};
}

}  // namespace

Result<void> check_model(const Model& model) {
  if (model.opset < kOldestOpset || model.opset > kNewestOpset)
    return wrong(fmt::format("it uses operator set {}; supported are {} to {}", model.opset,
                             kOldestOpset, kNewestOpset));
  if (model.inputs.empty() || model.outputs.empty())
    return wrong("its graph has no inputs or no outputs");
  for (const Port& port : model.inputs)
    if (auto sound = check_port(port, "input"); !sound) return sound;
  for (const Port& port : model.outputs)
    if (auto sound = check_port(port, "output"); !sound) return sound;
  if (auto sound = check_nodes(model); !sound) return sound;
  return check_constants(model);
}

}  // namespace handcast::landmarks::onnx
