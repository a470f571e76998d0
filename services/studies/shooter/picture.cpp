// SPDX-License-Identifier: Apache-2.0
#include "services/studies/shooter/picture.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "services/lab/twin/random.hpp"

namespace handcast::study {
namespace {

using Scene = ShooterScene;

// RGBA8 in memory: 0xAABBGGRR.
constexpr std::uint32_t kSpace = 0xff331408, kShip = 0xffffe08c, kShot = 0xff9cffd0,
                        kBomb = 0xff4a7bff, kBurst = 0xff40d0ff, kInk = 0xffffffff,
                        kAlive = 0xff7ce38b, kGone = 0xff3a3440;
constexpr std::array<std::uint32_t, 3> kAliens{0xffff8ad8, 0xff63e6ff, 0xff8dff9b};

/// Our own shapes, a character a dot.
constexpr std::array<std::string_view, 8> kAlienShape{
    "..#..#..", ".######.", "##.##.##", "########", "########", ".#.##.#.", "#..##..#", ".#....#."};
constexpr std::array<std::string_view, 8> kShipShape{
    "...##...", "...##...", "..####..", "..####..", ".##..##.", "########", "########", "##.##.##"};
/// Digits of 3 x 5 dots, from the top, three bits a row.
constexpr std::array<std::array<int, 5>, 10> kDigits{{{7, 5, 5, 5, 7},
                                                      {2, 6, 2, 2, 7},
                                                      {7, 1, 7, 4, 7},
                                                      {7, 1, 3, 1, 7},
                                                      {5, 5, 7, 1, 1},
                                                      {7, 4, 7, 1, 7},
                                                      {7, 4, 7, 5, 7},
                                                      {7, 1, 2, 2, 2},
                                                      {7, 5, 7, 5, 7},
                                                      {7, 5, 7, 1, 7}}};

/// The colour where a shape of 8 x 8 dots, `size_mm` wide, has a dot.
auto dots(const std::array<std::string_view, 8>& shape, float size_mm, std::uint32_t colour) {
  return [&shape, size_mm, colour](const glm::vec2& at_mm) {
    const glm::ivec2 dot =
        glm::clamp(glm::ivec2((glm::vec2(at_mm.x, -at_mm.y) / size_mm + 0.5f) * 8.f), 0, 7);
    const auto row = shape[static_cast<std::size_t>(dot.y)];
    return row[static_cast<std::size_t>(dot.x)] == '#' ? colour : 0u;
  };
}

auto disc(float radius_mm, std::uint32_t colour) {
  return [radius_mm, colour](const glm::vec2& at_mm) {
    return glm::length(at_mm) < radius_mm ? colour : 0u;
  };
}

}  // namespace

void ShooterPicture::stars(const Patch& palm, double time_s) {
  const twin::Random random(3, twin::Stream::image_clutter);
  for (std::uint64_t star = 0; star < 40; ++star) {
    const auto x = static_cast<float>(random.spread(star, 0)) * 38;
    const double fall_mm = time_s * (2 + 5 * random.uniform(star, 1));
    const double y = 45 - std::fmod(90 * random.uniform(star, 2) + fall_mm, 90);
    const auto grey = static_cast<std::uint32_t>(90 + 120 * random.uniform(star, 3));
    paint(picture_, palm, {x, static_cast<float>(y)}, 1,
          disc(0.5f, 0xff000000u | grey << 16 | grey << 8 | grey));
  }
}

void ShooterPicture::number(int value, const Patch& patch, const glm::vec2& at_mm, float height_mm,
                            std::uint32_t colour) {
  const std::string text = fmt::format("{}", value);
  const float dot_mm = height_mm / 5, step_mm = 4 * dot_mm;
  const float first_mm = -0.5f * step_mm * static_cast<float>(text.size() - 1);
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto& digit = kDigits[static_cast<std::size_t>(text[i] - '0')];
    paint(picture_, patch, at_mm + glm::vec2(first_mm + step_mm * static_cast<float>(i), 0),
          height_mm, [&](const glm::vec2& place_mm) {
            const int column = static_cast<int>(std::floor(place_mm.x / dot_mm + 1.5f)),
                      row = std::clamp(static_cast<int>((0.5f * height_mm - place_mm.y) / dot_mm),
                                       0, 4);
            if (column < 0 || column > 2) return 0u;
            return digit[static_cast<std::size_t>(row)] >> (2 - column) & 1 ? colour : 0u;
          });
  }
}

renderer::View<const std::uint32_t> ShooterPicture::draw(const ShooterScene& scene, Face face,
                                                         double time_s) {
  std::ranges::fill(picture_.pixels(), kSpace);
  const auto& palm = layout_.palm(face);
  stars(palm, time_s);
  constexpr float kAlien_mm = 7, kShip_mm = 8;
  for (const auto& alien : scene.aliens)
    paint(picture_, palm, alien.at_mm, kAlien_mm,
          dots(kAlienShape, kAlien_mm, kAliens[static_cast<std::size_t>(alien.kind)]));
  for (const auto& shot : scene.shots_mm) paint(picture_, palm, shot, 3, disc(1, kShot));
  for (const auto& bomb : scene.bombs_mm) paint(picture_, palm, bomb, 3.6f, disc(1.5f, kBomb));
  for (const auto& burst : scene.bursts_mm) paint(picture_, palm, burst, 11, disc(4.5f, kBurst));
  const bool is_shown = scene.blink_s <= 0 || std::fmod(scene.blink_s, 0.3) > 0.15;
  if (scene.is_playing && is_shown)
    paint(picture_, palm, {scene.ship_mm, Scene::kBottom_mm}, kShip_mm,
          dots(kShipShape, kShip_mm, kShip));
  if (!scene.is_playing) number(scene.score, palm, {}, 16, kInk);
  number(scene.score, layout_.tip(0, face), {0, -3}, 6, kInk);
  for (int finger = 0; finger < Scene::kLives; ++finger)
    paint(picture_, layout_.tip(static_cast<std::size_t>(finger) + 1, face), {0, -4}, 16,
          [&](const glm::vec2& at_mm) {
            const bool is_bar = glm::abs(at_mm.y) < 2.2f;
            return is_bar ? (finger < scene.lives ? kAlive : kGone) : 0u;
          });
  return picture_.view();
}

}  // namespace handcast::study
