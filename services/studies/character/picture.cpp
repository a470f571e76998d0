// SPDX-License-Identifier: Apache-2.0
#include "services/studies/character/picture.hpp"

#include <fmt/format.h>

#include <string_view>

#include "services/tools/preview/canvas/canvas.hpp"

namespace handcast::study {
namespace {

constexpr int kLetter_px = 96;
constexpr float kPalmLetter_mm = 46, kTipLetter_mm = 15;
constexpr float kJump_mm = 2.2f;  ///< at most, of the characters on the tips
constexpr std::uint32_t kSkin = 0xff2a1a10, kInk = 0xffffffff, kBusy = 0xff50b4ff;

}  // namespace

CharacterPicture::CharacterPicture(const renderer::HandMesh& mesh, int width_px, int height_px)
    : layout_(mesh, width_px, height_px), picture_(width_px, height_px) {}

/// Writes a character whose capitals are `size_mm` high, as is its square.
void CharacterPicture::letter(char character, const Patch& patch, const glm::vec2& at_mm,
                              float size_mm, std::uint32_t colour) {
  auto [found, is_new] = letters_.try_emplace(character, 1, 1);
  if (is_new) {
    preview::Canvas canvas(kLetter_px, kLetter_px, preview::Colour::of(0));
    canvas.text({0.5f * kLetter_px, 0.85f * kLetter_px}, std::string_view(&character, 1),
                {.size_px = 0.95 * kLetter_px, .bold = true}, preview::Colour::of(0xffffff),
                preview::Align::centre);
    found->second = canvas.picture();
  }
  const auto& shape = found->second;
  paint(picture_, patch, at_mm, size_mm, [&](const glm::vec2& place_mm) {
    const glm::vec2 at =
        (glm::vec2(place_mm.x, -place_mm.y) / size_mm + 0.5f) * static_cast<float>(kLetter_px);
    const glm::ivec2 pixel = glm::clamp(glm::ivec2(at), 0, kLetter_px - 1);
    return (colour & 0xffffffu) | (shape.at(pixel.x, pixel.y) & 0xff) << 24;
  });
}

renderer::View<const std::uint32_t> CharacterPicture::draw(const CharacterScene& scene, Face face) {
  using Phase = CharacterScene::Phase;
  std::ranges::fill(picture_.pixels(), kSkin);
  const auto& palm = layout_.palm(face);
  if (scene.phase == Phase::counting)
    letter(static_cast<char>('0' + scene.countdown), palm, {}, kPalmLetter_mm, kBusy);
  if (scene.phase == Phase::waiting || scene.phase == Phase::straighten)
    for (const float x : {-12.f, 0.f, 12.f}) letter('.', palm, {x, 0}, 30, kBusy);
  if (scene.phase != Phase::asking) return picture_.view();
  letter(scene.palm, palm, {}, kPalmLetter_mm, kInk);
  for (std::size_t tip = 0; tip < kTips; ++tip)
    letter(scene.tips[tip], layout_.tip(tip + 1, face), kJump_mm * scene.shift[tip], kTipLetter_mm,
           kInk);
  return picture_.view();
}

}  // namespace handcast::study
