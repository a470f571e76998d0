// SPDX-License-Identifier: Apache-2.0
#include "services/lab/training/contact_sheet.hpp"

#include "renderer/media/picture.hpp"

namespace handcast::landmarks::training {
namespace {

constexpr int kZoom = 2, kColumns = 10, kTile = handcast_network::kSide_px * kZoom;

std::uint32_t colour(int red, int green, int blue) {
  return 0xff000000u | static_cast<std::uint32_t>(red | green << 8 | blue << 16);
}

void draw_point(renderer::Texture& sheet, int left, int top, glm::vec2 place, std::uint32_t value) {
  const int x = static_cast<int>(place.x * kTile), y = static_cast<int>(place.y * kTile);
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      if (x + dx >= 0 && x + dx < kTile && y + dy >= 0 && y + dy < kTile)
        sheet.at(left + x + dx, top + y + dy) = value;
}

void draw_sample(renderer::Texture& sheet, int left, int top, const Sample& sample) {
  for (int y = 0; y < kTile; ++y)
    for (int x = 0; x < kTile; ++x) {
      const auto row = static_cast<std::size_t>(y / kZoom),
                 column = static_cast<std::size_t>(x / kZoom);
      const int grey = sample.image[row * handcast_network::kSide_px + column];
      sheet.at(left + x, top + y) = colour(grey, grey, grey);
    }
  for (std::size_t i = 0; i < sample.truth.size(); ++i) {
    if (sample.has_tracker) draw_point(sheet, left, top, sample.tracker[i], colour(255, 40, 40));
    if (sample.has_hand)
      draw_point(sheet, left, top, sample.truth[i],
                 sample.visible[i] ? colour(60, 255, 60) : colour(0, 120, 200));
  }
}

}  // namespace

Result<void> write_contact_sheet(Generator& generator, int count,
                                 const std::filesystem::path& file) {
  renderer::Texture sheet(kColumns * kTile, (count + kColumns - 1) / kColumns * kTile,
                          colour(0, 0, 0));
  for (int i = 0; i < count; ++i)
    draw_sample(sheet, i % kColumns * kTile, i / kColumns * kTile,
                generator.make(static_cast<std::uint64_t>(i)));
  return renderer::write_png(file, sheet.view());
}

}  // namespace handcast::landmarks::training
