// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "ipc/msg/header.hpp"
#include "ipc/shm/layout.hpp"

namespace handcast::ipc {

/// A message type with a tail: used_bytes() is its size, tail included. It is called on bytes that
/// may be torn or hostile, so it must be safe for any values of the fields.
template <class T>
concept HasTail = requires(const T& message) {
  { message.used_bytes() } -> std::convertible_to<std::size_t>;
};

/// The properties of a message type that RingReader and RingWriter need.
struct MessageShape {
  std::string_view layout;                                ///< T::layout
  std::uint64_t type_hash = 0;                            ///< msg::type_hash<T>()
  std::size_t bytes = 0;                                  ///< size without a tail
  std::size_t (*used_bytes)(const std::byte*) = nullptr;  ///< size of a message, tail included
};

/// The shape of a message type. Does not compile for types that cannot be shared between processes.
template <class T>
constexpr MessageShape shape_of() {
  static_assert(std::is_trivially_copyable_v<T> && std::is_standard_layout_v<T>,
                "a message is plain bytes");
  static_assert(std::is_same_v<decltype(T::header), msg::Header> && offsetof(T, header) == 0,
                "a message begins with its header");
  static_assert(alignof(T) <= kLineBytes);
  const auto used_bytes = [](const std::byte* message) -> std::size_t {
    if constexpr (HasTail<T>)
      return reinterpret_cast<const T*>(message)->used_bytes();
    else
      return sizeof(T);
  };
  return {T::layout, msg::type_hash<T>(), sizeof(T), used_bytes};
}

}  // namespace handcast::ipc
