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

/// Thrown while a program is built, caught where the network is opened.
struct Refused {
  std::string what;
};

/// A node that cannot be run: "Conv 'x' <why>".
[[noreturn]] void refuse(const Node& node, const std::string& why);

/// oneDNN's own scratchpads belong to the thread that made the primitive; ours to the program.
dnnl::primitive_attr own_scratchpad();

/// Row-major.
dnnl::memory::desc plain_desc(const Shape& shape);
/// The axes in the order in which those of `like` lie; row-major where `like` lies in blocks.
dnnl::memory::desc desc_like(const dnnl::memory::desc& like, const Shape& shape);
/// Any layout: the primitive chooses.
dnnl::memory::desc any_desc(const Shape& shape);

/// Where the operators put their steps: knows each ONNX value by name, and moves values between
/// layouts.
class Builder {
 public:
  Builder(const onnx::Model& model, const std::vector<Group>& groups);

  /// Which of the groups the steps belong to that come now.
  void begin(int group) { now_ = group; }

  Program& program() { return program_; }
  const dnnl::engine& engine() const { return program_.engine(); }

  /// An input of a node; a constant too. Refuses where there is none or it holds whole numbers.
  Value operand(const Node& node, std::size_t input);
  /// An input that must be a constant; null where it is left out.
  const onnx::Tensor* constant(const Node& node, std::size_t input) const;
  /// The same as a list of whole numbers; none where it is left out.
  std::optional<std::vector<std::int64_t>> integers(const Node& node, std::size_t input) const;

  void define(const std::string& name, const Value& value) { values_[name] = value; }
  /// Refuses a name that no step makes.
  const Value& value(const std::string& name) const;

  /// Room for a new value.
  Value make(const dnnl::memory::desc& desc);
  /// `value` in the layout of `desc`: itself where it lies so, else through a reorder.
  Value in_layout(const Value& value, const dnnl::memory::desc& desc);
  Value plain(const Value& value) { return in_layout(value, plain_desc(shape_of(value))); }
  /// The same, in memory that may be overwritten: its own where nothing needs it any more, else a
  /// copy's.
  Value to_overwrite(const Value& value, const dnnl::memory::desc& desc);
  /// Room for what is made of `value` number by number: its own where nothing needs it any more.
  Value make_over(const Value& value) {
    return may_overwrite(value.buffer) ? value : make(value.desc);
  }
  /// Numbers known at load, in the layout of `desc`; `given` is how they lie now.
  Value weights(const std::vector<float>& numbers, const dnnl::memory::desc& given,
                const dnnl::memory::desc& desc);

  void count_multiplications(double count) { multiplications_ += count; }
  double multiplications() const { return multiplications_; }

  static Shape shape_of(const Value& value) { return value.desc.dims(); }

 private:
  bool may_overwrite(int buffer) const;

  const onnx::Model& model_;
  std::map<std::string, std::vector<int>>
      users_;  ///< the groups that use a value, a group once for each use
  int now_ = 0;
  double multiplications_ = 0;
  Program program_;
  std::map<std::string, Value> values_;
};

}  // namespace handcast::landmarks::onednn
