// SPDX-License-Identifier: Apache-2.0
#include "services/camera/v4l2/newest_image.hpp"

namespace handcast::camera::v4l2 {
namespace {

Result<std::vector<Numbered>> take_all(Stream& stream, LossCount& losses) {
  std::vector<Numbered> images;
  while (images.size() < stream.buffers()) {
    const auto image = stream.take();
    if (!image) return tl::make_unexpected(image.error());
    if (!*image) return images;
    images.push_back({**image, losses.arrived((*image)->sequence)});
  }
  losses.all_were_full();
  return images;
}

}  // namespace

Result<std::optional<Numbered>> take_newest(Stream& stream, LossCount& losses) {
  const auto images = take_all(stream, losses);
  if (!images) return tl::make_unexpected(images.error());
  const bool is_late = images->size() == stream.buffers();
  std::optional<Numbered> newest;
  for (const auto& one : *images) {
    const bool is_broken = one.image.is_broken || one.image.bytes.empty();
    const bool is_dropped = is_broken || is_late;
    if (is_broken) losses.incomplete();
    if ((!is_broken && is_late) || (!is_dropped && newest)) losses.skipped();
    const auto* given = is_dropped ? &one : newest ? &*newest : nullptr;
    if (given != nullptr)
      if (auto done = stream.give_back(given->image); !done)
        return tl::make_unexpected(done.error());
    if (!is_dropped) newest = one;
  }
  return newest;
}

}  // namespace handcast::camera::v4l2
