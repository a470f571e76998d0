// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <dnnl.hpp>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "services/landmarks/inference/onednn/fuse.hpp"
#include "services/landmarks/inference/onnx/model.hpp"

namespace handcast::landmarks::onednn {

/// Frees memory that begins at a cache line.
struct AlignedDelete {
  /// `bytes`: from operator new[] with an alignment of 64.
  void operator()(std::byte* bytes) const { ::operator delete[](bytes, std::align_val_t{64}); }
};
/// Memory that begins at a cache line.
using AlignedBytes = std::unique_ptr<std::byte[], AlignedDelete>;
/// `size` bytes of 0.
AlignedBytes zeroed_bytes(std::size_t size);

/// A tensor: its layout in a buffer. Several may share a buffer, as views.
struct Value {
  dnnl::memory::desc desc;  ///< shape and layout
  int buffer = -1;          ///< number of the buffer
};

/// An argument of a primitive.
struct Argument {
  int role;     ///< DNNL_ARG_...
  Value value;  ///< the tensor
};

/// Primitives in the order in which they run, and the memory between them. It is built once; run()
/// does not allocate. Buffers that are not in use at the same time share memory. One thread.
class Program {
 public:
  /// oneDNN's engine.
  const dnnl::engine& engine() const { return engine_; }

  /// The most memory of a network; the largest known one needs 20 MB.
  static constexpr std::size_t kMostBytes = std::size_t{256} << 20;
  /// An exception: the network needs more than kMostBytes.
  struct TooLarge {};

  /// Adds a buffer for a value that one step writes and later ones read. Returns its number.
  int add_buffer(std::size_t bytes);
  /// Adds a buffer of zeros that shares its memory with no other: for inputs, outputs, weights.
  /// Returns its number. Throws TooLarge.
  int add_fixed_buffer(std::size_t bytes);
  /// Whether the buffer is one of add_fixed_buffer().
  bool is_fixed(int buffer) const { return buffers_[buffer].fixed != nullptr; }
  /// The memory of a fixed buffer.
  void* data(int buffer) { return buffers_[buffer].fixed.get(); }
  /// Frees a fixed buffer that no step uses.
  void drop(int buffer);
  /// Runs a reorder between two fixed buffers at once; it is not a step of the program.
  void reorder_now(const Value& from, const Value& to);

  /// Adds a primitive. `scratchpad`: its temporary memory.
  void add_step(const dnnl::primitive& primitive, std::vector<Argument> arguments,
                const dnnl::memory::desc& scratchpad = {});
  /// Assigns memory to all buffers; nothing can be added afterwards. Throws TooLarge.
  void finish();

  /// Runs all steps once.
  void run();

 private:
  struct Buffer {
    std::size_t bytes = 0, offset = 0;
    int first = -1, last = -1;  ///< the first and the last step that use it
    AlignedBytes fixed;
  };
  struct Step {
    dnnl::primitive primitive;
    std::vector<Argument> arguments;
    std::vector<dnnl::memory> memories;
    std::vector<dnnl_exec_arg_t> bound;
  };

  void claim(std::size_t bytes);
  void note_lifetimes();
  std::size_t place_buffers();
  void bind();
  void* place(int buffer) const;

  dnnl::engine engine_{dnnl::engine::kind::cpu, 0};
  dnnl::stream stream_{engine_};
  std::vector<Buffer> buffers_;
  std::vector<Step> steps_;
  AlignedBytes arena_;
  std::size_t bytes_ = 0;  ///< of the fixed buffers and, after finish(), of the arena
};

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
