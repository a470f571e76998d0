// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <dnnl.hpp>
#include <memory>
#include <new>
#include <vector>

namespace handcast::landmarks::onednn {

/// Memory on a cache line's boundary.
struct AlignedDelete {
  void operator()(std::byte* bytes) const { ::operator delete[](bytes, std::align_val_t{64}); }
};
using AlignedBytes = std::unique_ptr<std::byte[], AlignedDelete>;
AlignedBytes zeroed_bytes(std::size_t size);

/// A tensor: how it lies in a buffer. Several may share one: views of one another.
struct Value {
  dnnl::memory::desc desc;
  int buffer = -1;
};

struct Argument {
  int role;  ///< DNNL_ARG_...
  Value value;
};

/// Primitives in the order they run, and the memory between them. Built once; run() allocates
/// nothing of its own. Memory that only lives between two steps is shared by all that do not live
/// at the same time.
class Program {
 public:
  const dnnl::engine& engine() const { return engine_; }

  /// What a network may have in all; the largest known one has 20 MB.
  static constexpr std::size_t kMostBytes = std::size_t{256} << 20;
  struct TooLarge {};

  /// For values that one step writes and later ones read.
  int add_buffer(std::size_t bytes);
  /// Zeroed, never shared: inputs, outputs, weights. Throws TooLarge.
  int add_fixed_buffer(std::size_t bytes);
  bool is_fixed(int buffer) const { return buffers_[buffer].fixed != nullptr; }
  /// Of a fixed buffer.
  void* data(int buffer) { return buffers_[buffer].fixed.get(); }
  /// A fixed buffer that no step will use.
  void drop(int buffer);
  /// Only now, while the program is built: a reorder between two fixed buffers.
  void reorder_now(const Value& from, const Value& to);

  void add_step(const dnnl::primitive& primitive, std::vector<Argument> arguments,
                const dnnl::memory::desc& scratchpad = {});
  /// Gives every buffer its place. Nothing is added afterwards. Throws TooLarge.
  void finish();

  void run();

 private:
  struct Buffer {
    std::size_t bytes = 0, offset = 0;
    int first = -1, last = -1;  ///< the steps between which it holds something
    AlignedBytes fixed;
  };
  struct Step {
    dnnl::primitive primitive;
    std::vector<Argument> arguments;
    std::vector<dnnl::memory> memories;
    std::vector<dnnl_exec_arg_t> bound;
  };

  void reckon(std::size_t bytes);
  void note_lifetimes();
  std::size_t place_buffers();
  void bind();
  void* place(int buffer) const;

  dnnl::engine engine_{dnnl::engine::kind::cpu, 0};
  dnnl::stream stream_{engine_};
  std::vector<Buffer> buffers_;
  std::vector<Step> steps_;
  AlignedBytes arena_;
  std::size_t bytes_ = 0;  ///< of the fixed buffers, and of the arena when it is there
};

}  // namespace handcast::landmarks::onednn
