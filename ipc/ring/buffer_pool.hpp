#pragma once
#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <vector>

#include "ipc/shm/layout.hpp"

namespace handcast::ipc {

/// Buffers of one size, handed out as shared pointers and used again when the last pointer is gone: no allocation per
/// message once as many exist as are held at a time.
class BufferPool {
 public:
  explicit BufferPool(std::size_t bytes) : bytes_(round_up(bytes, kLineBytes)) {}

  std::shared_ptr<std::byte> take() {
    const auto unused = std::find_if(buffers_.begin(), buffers_.end(), [](const auto& buffer) { return buffer.use_count() == 1; });
    if (unused != buffers_.end()) return *unused;
    const auto give_back = [](std::byte* data) { ::operator delete (data, std::align_val_t{kLineBytes}); };
    auto* data = static_cast<std::byte*>(::operator new (bytes_, std::align_val_t{kLineBytes}));
    return buffers_.emplace_back(data, give_back);
  }

 private:
  std::size_t bytes_;
  std::vector<std::shared_ptr<std::byte>> buffers_;
};

}  // namespace handcast::ipc
