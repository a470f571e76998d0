// SPDX-License-Identifier: Apache-2.0
#include "services/tools/template/template.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/content/chart_map.hpp"
#include "renderer/content/textures.hpp"
#include "renderer/media/picture.hpp"

namespace handcast::picture {
namespace {

namespace fs = std::filesystem;

constexpr std::uint8_t kPaper = 255, kBorder = 0, kBone = 150;
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
  return Pictures{side == renderer::Side::left ? "left" : "right", std::move(*atlas),
                  line_drawing(*hand, width_px)};
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

renderer::Image<std::uint8_t> line_drawing(const renderer::HandMesh& hand, int width_px) {
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
