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

/// Private memory for one message.
class Buffer {
 public:
  std::byte* data() const { return data_.get(); }
  void give_back() {
    in_use_.store(false, std::memory_order_release);
  }  ///< from any thread; what was read before, was read before

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

/// Buffers of one size, handed out again and again: no allocation per message once as many exist as
/// are held at a time.
class BufferPool {
 public:
  explicit BufferPool(std::size_t bytes) : bytes_(round_up(bytes, kLineBytes)) {}

  /// Null where there is no memory. One thread.
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
