// SPDX-License-Identifier: Apache-2.0
#include "services/tools/template/template.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "renderer/content/chart_map.hpp"
#include "renderer/content/lettering.hpp"
#include "renderer/content/textures.hpp"
#include "renderer/media/picture.hpp"

namespace handcast::picture {
namespace {

namespace fs = std::filesystem;

constexpr std::uint8_t kPaper = 255, kBorder = 0, kBone = 150, kWord = 190;
constexpr int kBorder_px = 2, kPxPerLine = 1400;

/// True if the texel and another to the right of it or below, on one chart, belong to different
/// bones: a line of `line_px`.
bool is_between_bones(const renderer::ChartMap& charts, int x, int y, int width, int height,
                      int line_px) {
  const auto& here = charts.at(x, y);
  const auto differs = [&](int to_x, int to_y) {
    if (to_x >= width || to_y >= height) return false;
    const auto& there = charts.at(to_x, to_y);
    return there.chart == here.chart && there.joint != here.joint;
  };
  return differs(x + line_px, y) || differs(x, y + line_px);
}

/// A place in a picture, and how many texels it is the mean of.
struct Place {
  glm::dvec2 sum{0};
  int texels = 0;

  glm::vec2 middle() const { return glm::vec2(sum / static_cast<double>(texels)); }
};

/// A word, or an arrow, that says what a place is.
struct Sign {
  renderer::Image<std::uint8_t> shape;  ///< 255: drawn
  int x = 0, y = 0;                     ///< of its top left texel
};

Sign word(const std::string& text, glm::vec2 middle, int height) {
  Sign sign{renderer::whole_lettering(text, height)};
  sign.x = static_cast<int>(middle.x) - sign.shape.width() / 2;
  sign.y = static_cast<int>(middle.y) - sign.shape.height() / 2;
  return sign;
}

/// An arrow from one place to another.
Sign arrow(glm::vec2 from, glm::vec2 to, float half_px) {
  const float length = glm::distance(from, to), head = 7 * half_px;
  const auto along = (to - from) / std::max(length, 1.f);
  const auto low = glm::min(from, to) - head, high = glm::max(from, to) + head;
  Sign sign{renderer::Image<std::uint8_t>(static_cast<int>(high.x - low.x),
                                          static_cast<int>(high.y - low.y)),
            static_cast<int>(low.x), static_cast<int>(low.y)};
  for (int y = 0; y < sign.shape.height(); ++y)
    for (int x = 0; x < sign.shape.width(); ++x) {
      const auto at = glm::vec2(x, y) + low - from;
      const float forward = glm::dot(at, along), across = std::abs(at.x * along.y - at.y * along.x);
      const bool is_shaft = forward > 0 && forward < length - head && across < half_px;
      const bool is_head =
          forward < length && across < (length - forward) / 2 && forward > length - head;
      if (is_shaft || is_head) sign.shape.at(x, y) = 255;
    }
  return sign;
}

/// The names of the fingers, of back and palm, and where the fingertips are, on both sides of a
/// hand. Found from the bones below each texel, so that any layout has them.
std::vector<Sign> signs_of(const renderer::ChartMap& charts, std::string_view side, int width,
                           int height) {
  constexpr std::array<const char*, 5> kFingers{"thumb", "index", "middle", "ring", "little"};
  constexpr std::size_t kPalm = 5, kWrist = 6;
  const auto part_of = [](int joint) -> std::optional<std::size_t> {
    if (joint == 1) return kWrist;
    if (joint == 3 || joint == 4) return 0;
    if (joint < 6 || (joint - 6) % 5 == 0) return kPalm;
    return (joint - 6) % 5 < 3 ? std::optional<std::size_t>(1 + (joint - 6) / 5) : std::nullopt;
  };
  std::array<std::array<Place, 7>, 2> places{};  // by palm and back, by part
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (const auto& texel = charts.at(x, y); texel.chart != 0)
        if (const auto part = part_of(texel.joint)) {
          auto& place = places[charts.facing(texel.chart) > 0][*part];
          place.sum += glm::dvec2(x, y);
          ++place.texels;
        }
  std::vector<Sign> signs;
  const int small = std::max(16, width / 85), large = 2 * small;
  for (const bool is_back : {false, true}) {
    const auto& parts = places[is_back];
    for (std::size_t finger = 0; finger < kFingers.size(); ++finger)
      if (parts[finger].texels > 0)
        signs.push_back(word(kFingers[finger], parts[finger].middle(), small));
    if (parts[kPalm].texels == 0) continue;
    const auto palm = parts[kPalm].middle();
    signs.push_back(word(is_back ? "back" : "palm", palm, large));
    signs.push_back(word(fmt::format("{} hand", side), palm + glm::vec2(0, 1.4f * large), small));
    if (parts[kWrist].texels == 0) continue;
    const auto wrist = parts[kWrist].middle();
    const auto to = glm::mix(wrist, palm, 0.45f);
    signs.push_back(arrow(wrist, to, static_cast<float>(small) / 8));
    signs.push_back(word("up", wrist + glm::vec2(0, small), small));
  }
  return signs;
}

/// Calls `paint` with each texel of a sign that lies in a picture, and its coverage 0..1.
template <class Paint>
void each_texel(const Sign& sign, int width, int height, Paint paint) {
  for (int y = std::max(0, -sign.y); y < sign.shape.height() && sign.y + y < height; ++y)
    for (int x = std::max(0, -sign.x); x < sign.shape.width() && sign.x + x < width; ++x)
      paint(sign.x + x, sign.y + y, static_cast<float>(sign.shape.at(x, y)) / 255);
}

/// Writes on a coloured picture, with a plate of paper below each word.
void write_on(renderer::Texture& picture, const renderer::HandMesh& hand, std::string_view side) {
  const renderer::ChartMap charts(hand, picture.width(), picture.height());
  for (const auto& sign : signs_of(charts, side, picture.width(), picture.height()))
    each_texel(sign, picture.width(), picture.height(), [&](int x, int y, float coverage) {
      const auto grey = static_cast<std::uint32_t>(255 * (1 - coverage));
      picture.at(x, y) = 0xff000000u | grey << 16 | grey << 8 | grey;
    });
}

/// The pictures of a hand.
struct Pictures {
  const char* side;
  renderer::Texture coloured;
  renderer::Image<std::uint8_t> lines;
};

Result<Pictures> pictures_of(renderer::Side side, const std::string& file, int width_px) {
  const auto hand = renderer::load_hand_or_default(file, side);
  if (!hand) return tl::make_unexpected(hand.error());
  auto atlas = renderer::load_content("builtin:atlas", *hand);
  if (!atlas) return tl::make_unexpected(atlas.error());
  const char* name = side == renderer::Side::left ? "left" : "right";
  write_on(*atlas, *hand, name);
  return Pictures{name, std::move(*atlas), line_drawing(*hand, name, width_px)};
}

/// Checks that no file would be replaced: people paint on them.
Result<void> check_nothing_is_there(const fs::path& folder) {
  std::error_code unknown;
  for (const char* name : {"left.png", "left_lines.png", "right.png", "right_lines.png"})
    if (fs::exists(folder / name, unknown))
      return fail(Errc::bad_config,
                  fmt::format("{} exists and is left as it is; name another folder",
                              (folder / name).string()));
  return {};
}

}  // namespace

renderer::Image<std::uint8_t> line_drawing(const renderer::HandMesh& hand, std::string_view side,
                                           int width_px) {
  const int height_px = width_px / kProportionWidth * kProportionHeight;
  const int line_px = std::max(1, width_px / kPxPerLine);
  const renderer::ChartMap charts(hand, width_px, height_px);
  renderer::Image<std::uint8_t> drawing(width_px, height_px, kPaper);
  for (int y = 0; y < height_px; ++y)
    for (int x = 0; x < width_px; ++x) {
      const auto& texel = charts.at(x, y);
      if (texel.chart == 0) continue;
      if (texel.edge_px <= kBorder_px)
        drawing.at(x, y) = kBorder;
      else if (is_between_bones(charts, x, y, width_px, height_px, line_px))
        drawing.at(x, y) = kBone;
    }
  for (const auto& sign : signs_of(charts, side, width_px, height_px))
    each_texel(sign, width_px, height_px, [&](int x, int y, float coverage) {
      auto& texel = drawing.at(x, y);
      texel = std::min(texel, static_cast<std::uint8_t>(kPaper - (kPaper - kWord) * coverage));
    });
  return drawing;
}

Result<std::vector<fs::path>> write_templates(const config::Hand& hands, const fs::path& folder,
                                              int width_px) {
  if (auto free = check_nothing_is_there(folder); !free) return tl::make_unexpected(free.error());
  std::vector<Pictures> hands_pictures;
  for (const auto side : {renderer::Side::left, renderer::Side::right}) {
    auto pictures =
        pictures_of(side, side == renderer::Side::left ? hands.left : hands.right, width_px);
    if (!pictures) return tl::make_unexpected(pictures.error());
    hands_pictures.push_back(std::move(*pictures));
  }
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed)
    return fail(Errc::bad_config, fmt::format("the folder {} cannot be created: {}",
                                              folder.string(), failed.message()));
  std::vector<fs::path> written;
  for (const auto& [side, coloured, lines] : hands_pictures) {
    written.push_back(folder / fmt::format("{}.png", side));
    if (auto saved = renderer::write_png(written.back(), coloured.view()); !saved)
      return tl::make_unexpected(saved.error());
    written.push_back(folder / fmt::format("{}_lines.png", side));
    if (auto saved = renderer::write_png(written.back(), lines.view()); !saved)
      return tl::make_unexpected(saved.error());
  }
  return written;
}

}  // namespace handcast::picture
