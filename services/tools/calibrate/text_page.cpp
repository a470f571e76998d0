// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/text_page.hpp"

#include <algorithm>
#include <sstream>

#include "renderer/content/lettering.hpp"

namespace handcast::calibrate {
namespace {

using Picture = renderer::Image<std::uint8_t>;

constexpr double kUsed = 0.9;                 ///< of the picture's width and height
constexpr int kLargest = 12, kSmallest = 40;  ///< height of the picture in first lines

/// Breaks a line between words. A single word may be too wide.
std::vector<Picture> broken(const std::string& line, int height, double width_px) {
  std::vector<Picture> parts;
  std::istringstream words(line);
  std::string part;
  for (std::string word; words >> word;) {
    const auto longer = part.empty() ? word : part + " " + word;
    if (!part.empty() && renderer::whole_lettering(longer, height).width() > width_px) {
      parts.push_back(renderer::whole_lettering(part, height));
      part = word;
    } else {
      part = longer;
    }
  }
  if (!part.empty()) parts.push_back(renderer::whole_lettering(part, height));
  return parts;
}

std::vector<Picture> page_of(const std::vector<std::string>& lines, int height, double width_px) {
  std::vector<Picture> page;
  for (const auto& line : lines) {
    const int line_height = &line == &lines.front() ? height : height * 2 / 3;
    for (auto& part : broken(line, line_height, width_px)) page.push_back(std::move(part));
  }
  return page;
}

int gap_of(const Picture& line) { return line.height() / 4; }

int height_of(const std::vector<Picture>& page) {
  int height = 0;
  for (const auto& line : page) height += line.height() + gap_of(line);
  return height;
}

bool fits(const std::vector<Picture>& page, double width_px, double height_px) {
  return height_of(page) <= height_px &&
         std::ranges::all_of(page, [&](const auto& line) { return line.width() <= width_px; });
}

/// Copies a line into a picture, its middle at `x`, its top at `y`; what does not fit is cut off.
void put(const Picture& line, int x, int y, Picture& picture) {
  const int left = x - line.width() / 2;
  for (int row = 0; row < line.height(); ++row)
    for (int column = 0; column < line.width(); ++column)
      if (const int px = left + column, py = y + row;
          px >= 0 && px < picture.width() && py >= 0 && py < picture.height())
        picture.at(px, py) = line.at(column, row);
}

}  // namespace

void draw_text(const std::vector<std::string>& lines, Picture& picture) {
  const double width_px = kUsed * picture.width(), height_px = kUsed * picture.height();
  std::vector<Picture> page;
  for (int part = kLargest; part <= kSmallest; part += 2) {
    page = page_of(lines, picture.height() / part, width_px);
    if (fits(page, width_px, height_px)) break;
  }
  std::ranges::fill(picture.pixels(), std::uint8_t{0});
  int y = (picture.height() - height_of(page)) / 2;
  for (const auto& line : page) {
    put(line, picture.width() / 2, y, picture);
    y += line.height() + gap_of(line);
  }
}

}  // namespace handcast::calibrate
