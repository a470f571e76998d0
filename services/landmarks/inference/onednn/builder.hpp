// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "services/landmarks/inference/onednn/fuse.hpp"
#include "services/landmarks/inference/onednn/program.hpp"
#include "services/landmarks/inference/onnx/model.hpp"

namespace handcast::landmarks::onednn {

using onnx::Node;
using onnx::Shape;

/// An exception: the network cannot be run. It is thrown while a program is built and caught by the
/// function that opens the network.
struct Refused {
  std::string what;  ///< the reason, for the error
};

/// Throws Refused about a node: "Conv 'x' <why>".
[[noreturn]] void refuse(const Node& node, const std::string& why);

/// Attributes of a primitive whose scratchpad belongs to the program. (A scratchpad of oneDNN would
/// belong to the thread that made the primitive.)
dnnl::primitive_attr own_scratchpad();

/// A row-major layout.
dnnl::memory::desc plain_desc(const Shape& shape);
/// A layout with the axes in the same order as in `like`; row-major if `like` is blocked.
dnnl::memory::desc desc_like(const dnnl::memory::desc& like, const Shape& shape);
/// A layout that the primitive chooses.
dnnl::memory::desc any_desc(const Shape& shape);

/// Builds a program: the operators add their steps here. Finds ONNX values by name and converts
/// them between layouts.
class Builder {
 public:
  /// `model` must outlive the builder; `groups`: those of fuse().
  Builder(const onnx::Model& model, const std::vector<Group>& groups);

  /// Assigns the next steps to this group.
  void begin(int group) { now_ = group; }

  /// The program so far.
  Program& program() { return program_; }
  /// oneDNN's engine of the program.
  const dnnl::engine& engine() const { return program_.engine(); }

  /// An input of a node; it may be a constant. Throws Refused if there is none or it holds
  /// integers.
  Value operand(const Node& node, std::size_t input);
  /// An input that must be a constant; null if the node does not have it.
  const onnx::Tensor* constant(const Node& node, std::size_t input) const;
  /// The same as a list of integers; empty if the node does not have it.
  std::optional<std::vector<std::int64_t>> integers(const Node& node, std::size_t input) const;

  /// Names a value that the steps so far compute.
  void define(const std::string& name, const Value& value) { values_[name] = value; }
  /// The value of this name. Throws Refused if no step computes it.
  const Value& value(const std::string& name) const;

  /// Memory for a new value.
  Value make(const dnnl::memory::desc& desc);
  /// `value` in the layout of `desc`: itself if it has that layout, otherwise the result of a
  /// reorder.
  Value in_layout(const Value& value, const dnnl::memory::desc& desc);
  /// `value` in row-major layout.
  Value plain(const Value& value) { return in_layout(value, plain_desc(shape_of(value))); }
  /// `value` in the layout of `desc`, in memory that may be overwritten: itself if no later step
  /// needs it, otherwise a copy.
  Value to_overwrite(const Value& value, const dnnl::memory::desc& desc);
  /// Memory for the result of an elementwise operation on `value`: that of `value` if no later step
  /// needs it.
  Value make_over(const Value& value) {
    return may_overwrite(value.buffer) ? value : make(value.desc);
  }
  /// A constant in the layout of `desc`; `given` is the layout of `numbers`.
  Value weights(const std::vector<float>& numbers, const dnnl::memory::desc& given,
                const dnnl::memory::desc& desc);

  /// Adds to the number of multiplications with weights.
  void count_multiplications(double count) { multiplications_ += count; }
  /// The number of multiplications with weights in one run.
  double multiplications() const { return multiplications_; }

  /// The shape of a value.
  static Shape shape_of(const Value& value) { return value.desc.dims(); }

 private:
  bool may_overwrite(int buffer) const;

  const onnx::Model& model_;
  /// The groups that use each value; a group that uses it twice is listed twice.
  std::map<std::string, std::vector<int>> users_;
  int now_ = 0;
  double multiplications_ = 0;
  Program program_;
  std::map<std::string, Value> values_;
};

}  // namespace handcast::landmarks::onednn
