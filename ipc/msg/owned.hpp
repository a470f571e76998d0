// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <memory>
#include <new>

namespace handcast::msg {

/// A message with a tail in private memory, for programs without a ring (simulator, tests).
template <class T>
class Owned {
 public:
  /// Allocates zeroed memory of `bytes` bytes, tail included, at least sizeof(T), and constructs a
  /// T in it.
  explicit Owned(std::size_t bytes = sizeof(T))
      : bytes_(bytes < sizeof(T) ? sizeof(T) : bytes),
        memory_(new std::byte[bytes_]()),
        message_(new (memory_.get()) T) {}  // NOLINT(clang-analyzer-cplusplus.PlacementNew)

  /// The message; valid as long as this object.
  /// @{
  T& operator*() { return *message_; }
  const T& operator*() const { return *message_; }
  T* operator->() { return message_; }
  const T* operator->() const { return message_; }
  /// @}
  /// Bytes of memory behind T.
  std::size_t tail_bytes() const { return bytes_ - sizeof(T); }

 private:
  std::size_t bytes_;
  std::unique_ptr<std::byte[]> memory_;
  T* message_;
};

}  // namespace handcast::msg
