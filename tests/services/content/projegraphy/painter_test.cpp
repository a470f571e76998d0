// SPDX-License-Identifier: Apache-2.0
#include "services/content/projegraphy/painter.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "renderer/media/picture.hpp"
#include "services/content/skin_print.hpp"
#include "services/lab/gallery/contact_sheet.hpp"
#include "services/lab/gallery/hand_stage.hpp"
#include "tests/services/content/projegraphy/shadow_player.hpp"

namespace handcast::projegraphy {
namespace {

/// The picture of an animal that is held exactly.
renderer::Texture picture_of(const Animal& animal, ShadowPlayer& player) {
  player.hold(animal, 0, {0, 0, 0, 0, 0});
  const auto silhouette = player.silhouette();
  return painted(silhouette, *recogniser().place(silhouette, animal_of(animal.name)));
}

/// The hands that wear it, cut out of the projector's plane and shrunk to a cell.
renderer::Texture photo_of(const Animal& animal, ShadowPlayer& player) {
  const auto picture = picture_of(animal, player);
  const auto silhouette = player.silhouette();
  const float scale = silhouette.scale * kPictureSide_px / kMaskSide_px;
  const auto& hands = player.hands();
  std::array<renderer::Texture, 2> worn{renderer::Texture(640, 400), renderer::Texture(640, 400)};
  for (std::size_t i = 0; i < 2; ++i) {
    if (!hands[i].is_there) continue;
    content::SkinPrint print(*hands[i].mesh, 640, 400);
    print.take(content::viewer_of(player.calibration()), hands[i],
               hands[1 - i].is_there ? &hands[1 - i] : nullptr, picture,
               {glm::vec2(scale), 0.5f - silhouette.origin_px * scale});
    print.show(true, worn[i]);
  }
  gallery::HandStage stage(player.calibration());
  const auto photo = stage.take(hands, {&worn[0], &worn[1]});
  const auto region = stage.region();
  constexpr int kWidth = 200, kHeight = 160;
  const double by = std::max(region.width() / (kWidth - 8.), region.height() / (kHeight - 8.));
  renderer::Texture cell(kWidth, kHeight, 0xff0a0807);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      glm::vec3 sum(0);
      constexpr int kTaps = 4;
      for (int k = 0; k < kTaps * kTaps; ++k) {
        const int column = k % kTaps, row = k / kTaps;
        const int u = static_cast<int>(0.5 * (region.x0 + region.x1) +
                                       (x + (column + 0.5) / kTaps - 0.5 * kWidth) * by),
                  v = static_cast<int>(0.5 * (region.y0 + region.y1) +
                                       (y + (row + 0.5) / kTaps - 0.5 * kHeight) * by);
        const auto px =
            photo.at(std::clamp(u, 0, photo.width - 1), std::clamp(v, 0, photo.height - 1));
        sum += glm::vec3(px & 0xff, px >> 8 & 0xff, px >> 16 & 0xff);
      }
      const glm::uvec3 level(sum / static_cast<float>(kTaps * kTaps));
      cell.at(x, y) = 0xff000000u | level.b << 16 | level.g << 8 | level.r;
    }
  return cell;
}

TEST(Painter, PaintsTheSamePictureEachTimeAndAnotherOneOfEachAnimal) {
  ShadowPlayer player(0);
  std::set<std::vector<std::uint32_t>> pictures;
  for (const auto& animal : animals()) {
    const auto picture = picture_of(animal, player);
    EXPECT_EQ(picture.pixels(), picture_of(animal, player).pixels()) << animal.name;
    for (const auto texel : picture.pixels()) ASSERT_EQ(texel >> 24, 255u);
    pictures.insert(picture.pixels());
  }
  EXPECT_EQ(pictures.size(), animals().size());
}

/// Pixels of the silhouette whose channels are all above, or all below a level.
int count_of(const renderer::Texture& picture, const Silhouette& silhouette, bool above,
             int level) {
  int found = 0;
  for (int y = 0; y < kPictureSide_px; ++y)
    for (int x = 0; x < kPictureSide_px; ++x) {
      if (!silhouette.mask.at(x / 2, y / 2)) continue;
      const auto px = picture.at(x, y);
      bool all = true;
      for (int c = 0; c < 3; ++c) {
        const int its = content::level_of(px, c);
        all = all && (above ? its > level : its < level);
      }
      found += all;
    }
  return found;
}

// The highlight and the pupil.
TEST(Painter, EachAnimalHasAnEyeOnTheHand) {
  ShadowPlayer player(0);
  for (const auto& animal : animals()) {
    const auto picture = picture_of(animal, player);
    const auto silhouette = player.silhouette();
    EXPECT_GT(count_of(picture, silhouette, true, 240), 5) << animal.name;
    EXPECT_GT(count_of(picture, silhouette, false, 30), 25) << animal.name;
  }
}

// HANDCAST_SHEET=FILE.png keeps the sheet, for docs/operating/content.md.
TEST(Painter, AllAnimalsAreSeenOnTheHandsThatHoldThem) {
  ShadowPlayer player(37);
  gallery::ContactSheet sheet;
  for (const auto& animal : animals()) {
    const auto photo = photo_of(animal, player);
    int bright = 0;
    for (const auto px : photo.pixels())
      bright += std::max({px & 0xff, px >> 8 & 0xff, px >> 16 & 0xff}) > 60;
    EXPECT_GT(bright, 1500) << animal.name;
    sheet.add(std::string(animal.name), photo);
  }
  if (const char* file = std::getenv("HANDCAST_SHEET")) {
    const auto drawn = sheet.drawn();
    ASSERT_TRUE(renderer::write_png(file, drawn.view()));
  }
}

TEST(Painter, HandsThatLookLikeNothingGetSoftWavesInNoHurry) {
  const auto picture = calm_picture();
  ASSERT_EQ(picture.width(), kPictureSide_px);
  const auto differ = [](std::uint32_t a, std::uint32_t b) {
    int most = 0;
    for (const int shift : {0, 8, 16})
      most = std::max(most, std::abs(static_cast<int>(a >> shift & 0xff) -
                                     static_cast<int>(b >> shift & 0xff)));
    return most;
  };
  for (int y = 1; y < picture.height(); ++y)
    for (int x = 1; x < picture.width(); ++x) {
      ASSERT_LE(differ(picture.at(x, y), picture.at(x - 1, y)), 3);
      ASSERT_LE(differ(picture.at(x, y), picture.at(x, y - 1)), 3);
      ASSERT_GT(picture.at(x, y) >> 8 & 0xff, 40u) << "the hand is lit";
    }
  const char* folder = std::getenv("HANDCAST_PICTURES");
  EXPECT_TRUE(!folder || renderer::write_png(std::string(folder) + "/calm.png", picture.view()));
}

}  // namespace
}  // namespace handcast::projegraphy
