// SPDX-License-Identifier: Apache-2.0
#include "renderer/kms/buffer.hpp"

#include <drm_fourcc.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace handcast::renderer::kms {
namespace {

std::uint32_t with_blue_first(std::uint32_t rgba) {
  return (rgba & 0xff00ff00u) | (rgba & 0xff) << 16 | (rgba >> 16 & 0xff);
}

}  // namespace

Result<std::unique_ptr<Buffer>> Buffer::create(int card, int width_px, int height_px,
                                               PixelOrder order) {
  std::unique_ptr<Buffer> buffer(new Buffer(card, width_px, height_px, order));
  if (buffer->allocate()) return buffer;
  return fail(Errc::unavailable, fmt::format("the card has no memory for {}x{} pixels: {}",
                                             width_px, height_px, std::strerror(errno)));
}

bool Buffer::allocate() {
  const auto width = static_cast<std::uint32_t>(width_px_),
             height = static_cast<std::uint32_t>(height_px_);
  std::uint64_t size = 0, offset = 0;
  if (drmModeCreateDumbBuffer(card_, width, height, 32, 0, &handle_, &pitch_bytes_, &size) != 0)
    return false;
  const std::array<std::uint32_t, 4> handles{handle_}, pitches{pitch_bytes_}, offsets{};
  const auto format = order_ == PixelOrder::red_first ? DRM_FORMAT_XBGR8888 : DRM_FORMAT_XRGB8888;
  if (drmModeAddFB2(card_, width, height, format, handles.data(), pitches.data(), offsets.data(),
                    &id_, 0) != 0 ||
      drmModeMapDumbBuffer(card_, handle_, &offset) != 0)
    return false;
  void* memory =
      mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, card_, static_cast<off_t>(offset));
  if (memory == MAP_FAILED) return false;
  memory_ = static_cast<std::byte*>(memory);
  bytes_ = size;
  std::memset(memory_, 0, bytes_);
  return true;
}

Buffer::~Buffer() {
  if (memory_ != nullptr) munmap(memory_, bytes_);
  if (id_ != 0) drmModeRmFB(card_, id_);
  if (handle_ != 0) drmModeDestroyDumbBuffer(card_, handle_);
}

std::uint32_t* Buffer::row(int y) const {
  return reinterpret_cast<std::uint32_t*>(memory_ + static_cast<std::size_t>(y) * pitch_bytes_);
}

void Buffer::draw(View<const std::uint32_t> picture, Rect region) {
  region = region.within(std::min(width_px_, picture.width), std::min(height_px_, picture.height));
  const auto black = [&](int y, int x0, int x1) {
    if (x1 > x0) std::fill(row(y) + x0, row(y) + x1, 0u);
  };
  for (int y = lit_.y0; y < lit_.y1; ++y) {
    const bool is_drawn = y >= region.y0 && y < region.y1 && !region.empty();
    black(y, lit_.x0, is_drawn ? std::min(lit_.x1, region.x0) : lit_.x1);
    if (is_drawn) black(y, std::max(lit_.x0, region.x1), lit_.x1);
  }
  for (int y = region.y0; y < region.y1; ++y) {
    const std::uint32_t* from = picture.row(y) + region.x0;
    if (order_ == PixelOrder::red_first)
      std::copy_n(from, region.width(), row(y) + region.x0);
    else
      std::transform(from, from + region.width(), row(y) + region.x0, with_blue_first);
  }
  lit_ = region;
}

}  // namespace handcast::renderer::kms
