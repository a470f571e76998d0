// SPDX-License-Identifier: Apache-2.0
#include "services/lab/gallery/contact_sheet.hpp"

#include <algorithm>

#include "renderer/content/lettering.hpp"

namespace handcast::gallery {
namespace {

constexpr int kColumns = 4, kName_px = 22, kRow_px = 30;
constexpr std::uint32_t kPaper = 0xff0a0807;

void letter(renderer::Texture& sheet, const std::string& name, int middle, int top) {
  const auto letters = renderer::whole_lettering(name, kName_px);
  for (int y = 0; y < letters.height(); ++y)
    for (int x = 0; x < letters.width(); ++x) {
      const int to_x = middle - letters.width() / 2 + x, to_y = top + y;
      if (to_x < 0 || to_y < 0 || to_x >= sheet.width() || to_y >= sheet.height()) continue;
      const auto level = std::max<std::uint32_t>(letters.at(x, y) * 200u / 255u, 8u);
      sheet.at(to_x, to_y) = 0xff000000u | level * 0x010101u;
    }
}

/// A level of 5 bits.
std::uint32_t coarse(std::uint32_t level) { return std::min(255u, level + 4u) & 0xf8u; }

}  // namespace

void ContactSheet::add(const std::string& name, const renderer::Texture& picture) {
  cells_.push_back({name, picture});
}

renderer::Texture ContactSheet::drawn() const {
  const int count = static_cast<int>(cells_.size()), columns = std::min(kColumns, count),
            rows = (count + columns - 1) / columns;
  const int width = cells_[0].picture.width(), height = cells_[0].picture.height();
  renderer::Texture sheet(columns * width, rows * (height + kRow_px), kPaper);
  for (int i = 0; i < count; ++i) {
    const auto& picture = cells_[static_cast<std::size_t>(i)].picture;
    const int left = i % columns * width, top = i / columns * (height + kRow_px);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const auto pixel = picture.at(x, y);
        sheet.at(left + x, top + y) = 0xff000000u | coarse(pixel & 0xff) |
                                      coarse(pixel >> 8 & 0xff) << 8 |
                                      coarse(pixel >> 16 & 0xff) << 16;
      }
    letter(sheet, cells_[static_cast<std::size_t>(i)].name, left + width / 2, top + height + 2);
  }
  return sheet;
}

}  // namespace handcast::gallery
