// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace handcast::renderer {

/// Half-open rectangle of pixels [x0, x1) x [y0, y1).
struct Rect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  bool empty() const { return x1 <= x0 || y1 <= y0; }
  Rect grown(int px) const { return {x0 - px, y0 - px, x1 + px, y1 + px}; }
  Rect within(int width, int height) const {
    return {std::max(x0, 0), std::max(y0, 0), std::min(x1, width), std::min(y1, height)};
  }
  Rect overlap(const Rect& o) const {
    return {std::max(x0, o.x0), std::max(y0, o.y0), std::min(x1, o.x1), std::min(y1, o.y1)};
  }
  Rect joined(const Rect& o) const {
    if (empty()) return o;
    if (o.empty()) return *this;
    return {std::min(x0, o.x0), std::min(y0, o.y0), std::max(x1, o.x1), std::max(y1, o.y1)};
  }
};

/// Borrowed pixels, row by row.
template <class T>
struct View {
  T* data = nullptr;
  int width = 0, height = 0;
  int stride = 0;  ///< elements from one row to the next

  T* row(int y) const { return data + static_cast<std::ptrdiff_t>(y) * stride; }
  T& at(int x, int y) const { return row(y)[x]; }
  operator View<const T>() const { return {data, width, height, stride}; }
};

/// Owned pixels.
template <class T>
class Image {
 public:
  Image() = default;
  Image(int width, int height, T value = {})
      : width_(width), height_(height), pixels_(static_cast<std::size_t>(width) * height, value) {}

  int width() const { return width_; }
  int height() const { return height_; }
  T* row(int y) { return pixels_.data() + static_cast<std::ptrdiff_t>(y) * width_; }
  const T* row(int y) const { return pixels_.data() + static_cast<std::ptrdiff_t>(y) * width_; }
  T& at(int x, int y) { return row(y)[x]; }
  const T& at(int x, int y) const { return row(y)[x]; }
  View<T> view() { return {pixels_.data(), width_, height_, width_}; }
  View<const T> view() const { return {pixels_.data(), width_, height_, width_}; }
  std::vector<T>& pixels() { return pixels_; }
  const std::vector<T>& pixels() const { return pixels_; }

 private:
  int width_ = 0, height_ = 0;
  std::vector<T> pixels_;
};

using GreyView = View<const std::uint8_t>;

/// A borrowed grey image and the middle of its exposure.
struct TimedImage {
  GreyView view;               ///< data is null: there is no image
  std::int64_t origin_ns = 0;  ///< CLOCK_MONOTONIC
  std::uint64_t id = 0;        ///< the camera's number of it

  explicit operator bool() const { return view.data != nullptr; }
};

using Texture = Image<std::uint32_t>;  ///< RGBA8, red in the lowest byte, top row first; texture
                                       ///< coordinate v = 0 is the top

}  // namespace handcast::renderer
