// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <memory>
#include <new>

namespace handcast::msg {

/// A message with a tail in private memory: where no ring is (simulator, tests).
template <class T>
class Owned {
 public:
  explicit Owned(std::size_t bytes = sizeof(T))
      : bytes_(bytes < sizeof(T) ? sizeof(T) : bytes),
        memory_(new std::byte[bytes_]()),
        message_(new (memory_.get()) T) {}

  T& operator*() { return *message_; }
  const T& operator*() const { return *message_; }
  T* operator->() { return message_; }
  const T* operator->() const { return message_; }
  std::size_t tail_bytes() const { return bytes_ - sizeof(T); }

 private:
  std::size_t bytes_;
  std::unique_ptr<std::byte[]> memory_;
  T* message_;
};

}  // namespace handcast::msg
