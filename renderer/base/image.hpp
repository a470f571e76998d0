// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

/// The steps of the method, in the order of a frame: sensor data in, pixels for the projector out.
/// See docs/method.md.
namespace handcast::renderer {

/// Half-open rectangle of pixels [x0, x1) x [y0, y1), x to the right and y down.
struct Rect {
  /// Edges in pixels.
  /// @{
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  /// @}

  /// Size in pixels. Negative only if an edge was set so: never in a result of within() or
  /// overlap().
  /// @{
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  /// @}
  /// True if the rectangle contains no pixel.
  bool empty() const { return x1 <= x0 || y1 <= y0; }
  /// This rectangle with every edge moved outwards by `px`.
  Rect grown(int px) const { return {x0 - px, y0 - px, x1 + px, y1 + px}; }
  /// The part inside an image of `width` x `height` pixels; empty() if there is none.
  Rect within(int width, int height) const { return overlap({0, 0, width, height}); }
  /// The intersection of both; empty() and inside `o` if there is none.
  Rect overlap(const Rect& o) const {
    const int left = std::clamp(x0, o.x0, std::max(o.x0, o.x1)),
              top = std::clamp(y0, o.y0, std::max(o.y0, o.y1));
    return {left, top, std::clamp(x1, left, std::max(left, o.x1)),
            std::clamp(y1, top, std::max(top, o.y1))};
  }
  /// The smallest rectangle that contains both; an empty one is ignored.
  Rect joined(const Rect& o) const {
    if (empty()) return o;
    if (o.empty()) return *this;
    return {std::min(x0, o.x0), std::min(y0, o.y0), std::max(x1, o.x1), std::max(y1, o.y1)};
  }
};

/// Borrowed pixels, row by row from the top. A copy refers to the same pixels; no bounds are
/// checked.
template <class T>
struct View {
  T* data = nullptr;  ///< the first pixel of the top row
  /// Size in pixels.
  /// @{
  int width = 0, height = 0;
  /// @}
  int stride = 0;  ///< elements from one row to the next

  /// The first pixel of row `y`.
  T* row(int y) const { return data + static_cast<std::ptrdiff_t>(y) * stride; }
  /// The pixel in column `x` of row `y`.
  T& at(int x, int y) const { return row(y)[x]; }
  /// A read-only view of the same pixels.
  operator View<const T>() const { return {data, width, height, stride}; }
};

/// Owned pixels, row by row from the top, without a gap between the rows. No bounds are checked.
template <class T>
class Image {
 public:
  /// An image without pixels.
  Image() = default;
  /// An image of the given size in pixels, filled with `value`.
  Image(int width, int height, T value = {})
      : width_(width), height_(height), pixels_(static_cast<std::size_t>(width) * height, value) {}

  /// Size in pixels.
  /// @{
  int width() const { return width_; }
  int height() const { return height_; }
  /// @}
  /// The first pixel of row `y`.
  /// @{
  T* row(int y) { return pixels_.data() + static_cast<std::ptrdiff_t>(y) * width_; }
  const T* row(int y) const { return pixels_.data() + static_cast<std::ptrdiff_t>(y) * width_; }
  /// @}
  /// The pixel in column `x` of row `y`.
  /// @{
  T& at(int x, int y) { return row(y)[x]; }
  const T& at(int x, int y) const { return row(y)[x]; }
  /// @}
  /// A view of all pixels, valid until the image is destroyed or assigned to.
  /// @{
  View<T> view() { return {pixels_.data(), width_, height_, width_}; }
  View<const T> view() const { return {pixels_.data(), width_, height_, width_}; }
  /// @}
  /// All pixels, row after row.
  /// @{
  std::vector<T>& pixels() { return pixels_; }
  const std::vector<T>& pixels() const { return pixels_; }
  /// @}

 private:
  int width_ = 0, height_ = 0;
  std::vector<T> pixels_;
};

/// Borrowed grey values, 0 black to 255 white.
using GreyView = View<const std::uint8_t>;

/// A borrowed grey image of the camera, with the time and the number of its frame.
struct TimedImage {
  GreyView view;               ///< `data` is null if there is no image
  std::int64_t origin_ns = 0;  ///< middle of the exposure, CLOCK_MONOTONIC
  std::uint64_t id = 0;        ///< the camera's frame_id

  /// True if there is an image.
  explicit operator bool() const { return view.data != nullptr; }
};

/// RGBA8, red in the lowest byte. Texture coordinates (0, 0) to (1, 1) run from the top left to the
/// bottom right corner.
using Texture = Image<std::uint32_t>;

}  // namespace handcast::renderer
