// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <dnnl.hpp>
#include <memory>
#include <new>
#include <vector>

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

}  // namespace handcast::landmarks::onednn
