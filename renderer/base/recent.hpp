// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

namespace handcast::renderer {

/// The newest values of a stream, the oldest first, in one piece of memory that is allocated at the
/// start: a frame that adds a value and drops an old one allocates nothing. It grows if it has more
/// than `most` values. Pointers and iterators are valid until the next change. One thread.
template <class T>
class Recent {
 public:
  /// As in containers of the standard library.
  /// @{
  using value_type = T;
  using const_iterator = const T*;
  /// @}

  /// Without values.
  explicit Recent(std::size_t most) : slots_(2 * most) {}

  /// The values, the oldest first.
  /// @{
  const T* begin() const { return slots_.data() + first_; }
  const T* end() const { return begin() + size_; }
  auto rbegin() const { return std::reverse_iterator(end()); }
  auto rend() const { return std::reverse_iterator(begin()); }
  T* begin() { return slots_.data() + first_; }
  T* end() { return begin() + size_; }
  const T& front() const { return *begin(); }
  const T& back() const { return end()[-1]; }
  T& back() { return end()[-1]; }
  /// @}
  /// Number of values.
  std::size_t size() const { return size_; }
  /// True if there is no value.
  bool empty() const { return size_ == 0; }

  /// Adds a value before `place`, an iterator of this object.
  void insert(const T* place, const T& value) {
    const std::size_t index = static_cast<std::size_t>(place - begin());
    make_room();
    std::move_backward(begin() + index, end(), end() + 1);
    begin()[index] = value;
    ++size_;
  }
  /// Adds the newest value.
  void push_back(const T& value) { insert(end(), value); }
  /// Drops the oldest or the newest value, or all. There must be one.
  /// @{
  void pop_front() {
    ++first_;
    --size_;
  }
  void pop_back() { --size_; }
  void clear() { first_ = size_ = 0; }
  /// @}

 private:
  /// Moves the values to the start once per `most` of them, so that a value is moved about once.
  void make_room() {
    if (first_ + size_ < slots_.size()) return;
    if (size_ > slots_.size() / 2) slots_.resize(2 * size_);
    std::move(begin(), end(), slots_.begin());
    first_ = 0;
  }

  std::vector<T> slots_;
  std::size_t first_ = 0, size_ = 0;
};

}  // namespace handcast::renderer
