// SPDX-License-Identifier: Apache-2.0
// Operators that rearrange elements. Most of them only describe the same memory differently.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "services/landmarks/inference/onednn/operators.hpp"

namespace handcast::landmarks::onednn {

namespace {

std::size_t index_of_axis(const Node& node, std::int64_t axis, std::size_t rank) {
  const auto count = static_cast<std::int64_t>(rank);
  if (axis < -count || axis >= count) refuse(node, fmt::format("names axis {} of {}", axis, rank));
  return static_cast<std::size_t>(axis < 0 ? axis + count : axis);
}

void define_reshaped(Builder& builder, const Node& node, const Shape& shape) {
  const Value input = builder.operand(node, 0);
  if (onnx::elements(shape) != onnx::elements(input.desc.dims()))
    refuse(node, fmt::format("cannot reshape {} to {}", onnx::to_string(input.desc.dims()),
                             onnx::to_string(shape)));
  const Value plain = builder.plain(input);
  builder.define(node.outputs[0], {plain_desc(shape.empty() ? Shape{1} : shape), plain.buffer});
}

std::size_t emit_identity(Builder& builder, const Node& node, std::span<const Node>) {
  builder.define(node.outputs[0], builder.operand(node, 0));
  return 0;
}

std::size_t emit_transpose(Builder& builder, const Node& node, std::span<const Node>) {
  const Value input = builder.operand(node, 0);
  const std::size_t rank = input.desc.dims().size();
  Shape order(rank);
  for (std::size_t i = 0; i < rank; ++i) order[i] = static_cast<std::int64_t>(rank - 1 - i);
  order = node.integers("perm", order);
  // ONNX lists the source of each axis of the result, oneDNN the target of each axis of the input.
  std::vector<int> target(rank, -1);
  if (order.size() != rank)
    refuse(node, "has a permutation of another number of axes than its input");
  for (std::size_t i = 0; i < rank; ++i)
    target[index_of_axis(node, order[i], rank)] = static_cast<int>(i);
  if (std::find(target.begin(), target.end(), -1) != target.end())
    refuse(node, "names an axis twice");
  builder.define(node.outputs[0], {input.desc.permute_axes(target), input.buffer});
  return 0;
}

std::size_t emit_reshape(Builder& builder, const Node& node, std::span<const Node>) {
  const Shape from = builder.operand(node, 0).desc.dims();
  const auto wanted = builder.integers(node, 1);
  if (!wanted) refuse(node, "has no shape");
  Shape shape = *wanted;
  std::int64_t known = 1;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    if (shape[i] == 0 && i < from.size()) shape[i] = from[i];
    if (shape[i] == -1) continue;
    if (shape[i] < 1 || shape[i] > onnx::kMostElements / known)
      refuse(node, "has an invalid shape: " + onnx::to_string(*wanted));
    known *= shape[i];
  }
  if (std::count(shape.begin(), shape.end(), -1) > 1) refuse(node, "has two free extents");
  std::replace(shape.begin(), shape.end(), std::int64_t{-1}, onnx::elements(from) / known);
  define_reshaped(builder, node, shape);
  return 0;
}

std::size_t emit_flatten(Builder& builder, const Node& node, std::span<const Node>) {
  const Shape from = builder.operand(node, 0).desc.dims();
  const std::int64_t axis = node.integer("axis", 1), rank = static_cast<std::int64_t>(from.size());
  if (axis < -rank || axis > rank) refuse(node, fmt::format("names axis {} of {}", axis, rank));
  const auto split = from.begin() + (axis < 0 ? axis + rank : axis);
  define_reshaped(builder, node,
                  {onnx::elements({from.begin(), split}), onnx::elements({split, from.end()})});
  return 0;
}

/// The axes of Squeeze and Unsqueeze are an attribute up to operator set 12, an input since 13.
std::optional<Shape> axes_of(const Builder& builder, const Node& node) {
  if (node.has("axes")) return node.integers("axes", {});
  return builder.integers(node, 1);
}

std::size_t emit_squeeze(Builder& builder, const Node& node, std::span<const Node>) {
  const Shape from = builder.operand(node, 0).desc.dims();
  std::vector<bool> gone(from.size(), false);
  if (const auto axes = axes_of(builder, node)) {
    for (const std::int64_t axis : *axes) gone[index_of_axis(node, axis, from.size())] = true;
  } else {
    for (std::size_t i = 0; i < from.size(); ++i) gone[i] = from[i] == 1;
  }
  Shape shape;
  for (std::size_t i = 0; i < from.size(); ++i)
    if (!gone[i]) shape.push_back(from[i]);
  define_reshaped(builder, node, shape);
  return 0;
}

std::size_t emit_unsqueeze(Builder& builder, const Node& node, std::span<const Node>) {
  const Shape from = builder.operand(node, 0).desc.dims();
  const Shape axes = axes_of(builder, node).value_or(Shape{});
  const std::size_t rank = from.size() + axes.size();
  if (rank > 6) refuse(node, "has more than six axes");
  std::vector<bool> fresh(rank, false);
  for (const std::int64_t axis : axes) fresh[index_of_axis(node, axis, rank)] = true;
  if (std::count(fresh.begin(), fresh.end(), true) != static_cast<std::ptrdiff_t>(axes.size()))
    refuse(node, "names an axis twice");
  Shape shape;
  auto next = from.begin();
  for (const bool is_fresh : fresh) shape.push_back(is_fresh ? 1 : *next++);
  define_reshaped(builder, node, shape);
  return 0;
}

std::size_t emit_concat(Builder& builder, const Node& node, std::span<const Node>) {
  std::vector<Value> parts;
  std::vector<dnnl::memory::desc> descs;
  for (std::size_t i = 0; i < node.inputs.size(); ++i)
    descs.push_back(parts.emplace_back(builder.operand(node, i)).desc);
  if (parts.empty()) refuse(node, "has no inputs");
  const Shape first = descs[0].dims();
  const std::size_t axis = index_of_axis(node, node.integer("axis", 0), first.size());
  for (const auto& desc : descs) {
    Shape shape = desc.dims();
    if (shape.size() == first.size()) shape[axis] = first[axis];
    if (shape != first)
      refuse(node, fmt::format("cannot join {} and {}", onnx::to_string(first),
                               onnx::to_string(desc.dims())));
  }
  const dnnl::concat::primitive_desc chosen(static_cast<int>(axis), descs, builder.engine(),
                                            own_scratchpad());
  const Value output = builder.make(chosen.dst_desc());
  std::vector<Argument> arguments{{DNNL_ARG_DST, output}};
  for (std::size_t i = 0; i < parts.size(); ++i)
    arguments.push_back({DNNL_ARG_MULTIPLE_SRC + static_cast<int>(i), parts[i]});
  builder.program().add_step(dnnl::concat(chosen), arguments, chosen.scratchpad_desc());
  builder.define(node.outputs[0], output);
  return 0;
}

/// The layout of the part of `whole` that begins at `offsets`.
dnnl::memory::desc part_of(const Value& whole, const Shape& shape, const Shape& offsets) {
  return whole.desc.submemory_desc(shape, offsets);
}

/// The result has a fixed buffer, whose border stays zero; each run copies the input into its
/// middle.
std::size_t emit_pad(Builder& builder, const Node& node, std::span<const Node>) {
  const Value input = builder.operand(node, 0);
  const Shape from = input.desc.dims();
  const Shape pads =
      node.has("pads") ? node.integers("pads", {}) : builder.integers(node, 1).value_or(Shape{});
  const onnx::Tensor* with = builder.constant(node, 2);
  const bool zero =
      node.number("value", 0) == 0 && (!with || (with->floats.size() == 1 && with->floats[0] == 0));
  if (node.text("mode", "constant") != "constant" || !zero || pads.size() != 2 * from.size() ||
      node.has_input(3))
    refuse(node, "pads with other values than zeros, or only some axes");
  Shape shape = from;
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (std::min(pads[i], pads[i + from.size()]) < 0 ||
        std::max(pads[i], pads[i + from.size()]) > 65536)
      refuse(node, "has pads out of range");
    shape[i] += pads[i] + pads[i + from.size()];
  }
  const dnnl::memory::desc desc = desc_like(input.desc, shape);
  const Value output{desc, builder.program().add_fixed_buffer(desc.get_size())};
  const Value middle{
      part_of(output, from,
              {pads.begin(), pads.begin() + static_cast<std::ptrdiff_t>(from.size())}),
      output.buffer};
  const dnnl::reorder::primitive_desc copy(builder.engine(), input.desc, builder.engine(),
                                           middle.desc);
  builder.program().add_step(dnnl::reorder(copy), {{DNNL_ARG_FROM, input}, {DNNL_ARG_TO, middle}});
  builder.define(node.outputs[0], output);
  return 0;
}

struct Range {
  std::int64_t begin, count;
};

/// In ONNX, negative indices count from the end, and indices beyond the ends are clamped.
Range range_of(std::int64_t begin, std::int64_t end, std::int64_t extent) {
  const auto within = [extent](std::int64_t place) {
    return std::clamp<std::int64_t>(place < 0 ? place + extent : place, 0, extent);
  };
  return {within(begin), within(end) - within(begin)};
}

/// The ranges of a Slice are attributes up to operator set 9, inputs since 10.
struct Cuts {
  Shape starts, ends, axes;
};

Cuts cuts_of(const Builder& builder, const Node& node, std::size_t rank) {
  const auto list = [&](const char* attribute, std::size_t input) {
    return node.has(attribute) ? node.integers(attribute, {})
                               : builder.integers(node, input).value_or(Shape{});
  };
  Cuts cuts{list("starts", 1), list("ends", 2), list("axes", 3)};
  for (std::size_t i = 0; cuts.axes.size() < std::min(rank, cuts.starts.size()); ++i)
    cuts.axes.push_back(static_cast<std::int64_t>(i));
  const Shape steps = builder.integers(node, 4).value_or(Shape{});
  const bool single =
      std::all_of(steps.begin(), steps.end(), [](std::int64_t step) { return step == 1; });
  if (cuts.starts.size() != cuts.ends.size() || cuts.axes.size() != cuts.starts.size() || !single)
    refuse(node, "has steps other than 1, or ranges that do not match its axes");
  return cuts;
}

std::size_t emit_slice(Builder& builder, const Node& node, std::span<const Node>) {
  const Value input = builder.plain(builder.operand(node, 0));
  Shape shape = input.desc.dims(), offsets(shape.size(), 0);
  const Cuts cuts = cuts_of(builder, node, shape.size());
  for (std::size_t i = 0; i < cuts.starts.size(); ++i) {
    const std::size_t axis = index_of_axis(node, cuts.axes[i], shape.size());
    const Range range = range_of(cuts.starts[i], cuts.ends[i], input.desc.dims()[axis]);
    if (range.count < 1) refuse(node, "has an empty result");
    shape[axis] = range.count;
    offsets[axis] = range.begin;
  }
  builder.define(node.outputs[0], builder.plain({part_of(input, shape, offsets), input.buffer}));
  return 0;
}

std::size_t emit_split(Builder& builder, const Node& node, std::span<const Node>) {
  const Value input = builder.plain(builder.operand(node, 0));
  const Shape from = input.desc.dims();
  const std::size_t axis = index_of_axis(node, node.integer("axis", 0), from.size());
  const auto count = static_cast<std::int64_t>(node.outputs.size());
  const Shape even(node.outputs.size(), from[axis] / count);
  const Shape sizes =
      node.has("split") ? node.integers("split", {}) : builder.integers(node, 1).value_or(even);
  std::int64_t whole = 0;
  for (const std::int64_t size : sizes)
    whole += std::clamp<std::int64_t>(size, 0, onnx::kMostElements);
  if (sizes.size() != node.outputs.size() || whole != from[axis] ||
      *std::min_element(sizes.begin(), sizes.end()) < 1)
    refuse(node, fmt::format("cannot split {} into its parts", onnx::to_string(from)));
  Shape offsets(from.size(), 0);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    Shape shape = from;
    shape[axis] = sizes[i];
    builder.define(node.outputs[i], builder.plain({part_of(input, shape, offsets), input.buffer}));
    offsets[axis] += sizes[i];
  }
  return 0;
}

constexpr Operator kLayoutOperators[] = {
    {"Identity", emit_identity},   {"Dropout", emit_identity}, {"Transpose", emit_transpose},
    {"Reshape", emit_reshape},     {"Flatten", emit_flatten},  {"Squeeze", emit_squeeze},
    {"Unsqueeze", emit_unsqueeze}, {"Concat", emit_concat},    {"Pad", emit_pad},
    {"Slice", emit_slice},         {"Split", emit_split},
};

}  // namespace

std::span<const Operator> layout_operators() { return kLayoutOperators; }

}  // namespace handcast::landmarks::onednn
