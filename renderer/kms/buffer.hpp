// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>

#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"

namespace handcast::renderer::kms {

/// The order of the channels in the memory of a card.
enum class PixelOrder {
  red_first,   ///< DRM_FORMAT_XBGR8888, as in renderer::Texture
  blue_first,  ///< DRM_FORMAT_XRGB8888, which every driver has
};

/// A picture in the memory of a card that it can show, black at first. One thread.
class Buffer {
 public:
  /// Errors: unavailable (no memory).
  static Result<std::unique_ptr<Buffer>> create(int card, int width_px, int height_px,
                                                PixelOrder order);
  ~Buffer();
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;

  std::uint32_t id() const { return id_; }  ///< of the framebuffer
  /// Copies the region of a picture (RGBA8), black elsewhere. Writes only this region and what was
  /// lit before: reads nothing, because the memory may be uncached.
  void draw(View<const std::uint32_t> picture, Rect region);

 private:
  Buffer(int card, int width_px, int height_px, PixelOrder order)
      : card_(card), width_px_(width_px), height_px_(height_px), order_(order) {}
  bool allocate();
  std::uint32_t* row(int y) const;

  int card_;
  int width_px_, height_px_;
  PixelOrder order_;
  std::uint32_t handle_ = 0, pitch_bytes_ = 0, id_ = 0;
  std::size_t bytes_ = 0;
  std::byte* memory_ = nullptr;
  Rect lit_;  ///< what may differ from black
};

}  // namespace handcast::renderer::kms
