// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <new>
#include <vector>

#include "ipc/shm/layout.hpp"

namespace handcast::ipc {

/// Private memory for one message, owned by a BufferPool.
class Buffer {
 public:
  /// The first byte, aligned to kLineBytes.
  std::byte* data() const { return data_.get(); }
  /// Returns the buffer to its pool. Any thread. The release store orders all reads of the buffer
  /// before its next use.
  void give_back() { in_use_.store(false, std::memory_order_release); }

 private:
  friend class BufferPool;
  struct Free {
    void operator()(std::byte* data) const {
      ::operator delete (data, std::align_val_t{kLineBytes});
    }
  };
  explicit Buffer(std::byte* data) : data_(data) {}

  std::unique_ptr<std::byte, Free> data_;
  std::atomic<bool> in_use_{true};
};

/// Reusable buffers of one size. Allocates only if more buffers are in use than ever before.
class BufferPool {
 public:
  /// A pool of buffers of at least `bytes` bytes; allocates nothing yet.
  explicit BufferPool(std::size_t bytes) : bytes_(round_up(bytes, kLineBytes)) {}

  /// A buffer that is not in use, valid until the pool is destroyed; null if there is no memory.
  /// One thread.
  Buffer* take() {
    for (const auto& buffer : buffers_)
      if (!buffer->in_use_.load(std::memory_order_acquire)) {
        buffer->in_use_.store(true, std::memory_order_relaxed);
        return buffer.get();
      }
    auto* data = static_cast<std::byte*>(
        ::operator new (bytes_, std::align_val_t{kLineBytes}, std::nothrow));
    if (!data) return nullptr;
    return buffers_.emplace_back(new Buffer(data)).get();
  }

 private:
  std::size_t bytes_;
  std::vector<std::unique_ptr<Buffer>> buffers_;
};

}  // namespace handcast::ipc
