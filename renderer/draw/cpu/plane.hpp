// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/mman.h>

#include <cstddef>
#include <memory>
#include <new>

#include "renderer/base/image.hpp"

namespace handcast::renderer::cpu {

/// The pixels that a pass works on. Rows start on cache lines, have room for whole vectors past
/// their end, and are not a multiple of a page apart: otherwise the rows of one triangle would
/// share cache sets. They lie in huge pages, because a block of pixels touches as many rows of
/// several planes as a processor has entries for small ones.
template <class T>
class Plane {
 public:
  /// A plane of the given size in pixels, all T{}.
  Plane(int width, int height)
      : width_(width), height_(height), stride_(padded(width)), pixels_(allocate(count())) {}

  /// Size in pixels.
  /// @{
  int width() const { return width_; }
  int height() const { return height_; }
  /// @}
  /// Elements from one row to the next.
  int stride() const { return stride_; }
  /// The first pixel of row `y`.
  /// @{
  T* row(int y) { return pixels_.get() + static_cast<std::ptrdiff_t>(y) * stride_; }
  const T* row(int y) const { return pixels_.get() + static_cast<std::ptrdiff_t>(y) * stride_; }
  /// @}
  /// A view of all pixels, valid as long as the plane.
  /// @{
  View<T> view() { return {pixels_.get(), width_, height_, stride_}; }
  View<const T> view() const { return {pixels_.get(), width_, height_, stride_}; }
  /// @}

 private:
  static constexpr std::size_t kHugePage = 2 << 20;
  static constexpr std::align_val_t kAlignment{kHugePage};
  struct Free {
    void operator()(T* pixels) const { ::operator delete[](pixels, kAlignment); }
  };

  static int padded(int width) {
    const int stride = (width / 64 + 1) * 64;
    return stride * sizeof(T) % 4096 == 0 ? stride + 64 : stride;
  }
  std::size_t count() const { return static_cast<std::size_t>(stride_) * height_; }
  static std::unique_ptr<T[], Free> allocate(std::size_t count) {
    const std::size_t bytes = (count * sizeof(T) + kHugePage - 1) / kHugePage * kHugePage;
    auto* pixels = static_cast<T*>(::operator new[](bytes, kAlignment));
    madvise(pixels, bytes, MADV_HUGEPAGE);  // only faster: no matter if it is refused
    std::uninitialized_value_construct_n(pixels, count);
    return std::unique_ptr<T[], Free>(pixels);
  }

  int width_, height_, stride_;
  std::unique_ptr<T[], Free> pixels_;
};

}  // namespace handcast::renderer::cpu
