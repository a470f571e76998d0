// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "renderer/hand/hand_mesh.hpp"
#include "services/tools/preview/layout/panels.hpp"

namespace handcast::preview {
namespace {

constexpr double kBrightest = 0.995;  ///< share of the pixels that are not brightened to white
constexpr int kLeastWhite = 48;       ///< a dark image is not brightened to noise
constexpr double kSigmas = 3;         ///< radius of the circle around a landmark

/// The grey value that is shown as white.
int white_of(const renderer::Image<std::uint8_t>& camera) {
  std::array<std::size_t, 256> histogram{};
  for (const auto grey : camera.pixels()) ++histogram[grey];
  const double most = kBrightest * static_cast<double>(camera.pixels().size());
  double below = 0;
  for (int white = 0; white < 255; ++white)
    if ((below += static_cast<double>(histogram[static_cast<std::size_t>(white)])) >= most)
      return std::max(white, kLeastWhite);
  return 255;
}

/// Puts a colour on many pixels, in whole numbers, because there are hundreds of thousands.
class Tint {
 public:
  explicit Tint(Colour colour)
      : below_(static_cast<std::uint32_t>(std::lround(256 * (1 - colour.alpha)))) {
    const float share = 255 * 256 * colour.alpha;
    added_ = {static_cast<std::uint32_t>(share * colour.red),
              static_cast<std::uint32_t>(share * colour.green),
              static_cast<std::uint32_t>(share * colour.blue)};
  }
  std::uint32_t on(std::uint32_t below) const {
    const auto part = [&](int shift, std::uint32_t added) {
      return ((below >> shift & 255) * below_ + added) >> 8 << shift;
    };
    return 0xff000000u | part(0, added_[0]) | part(8, added_[1]) | part(16, added_[2]);
  }

 private:
  std::uint32_t below_;                 ///< share of what is below, of 256
  std::array<std::uint32_t, 3> added_;  ///< 256 times the level that the colour adds
};

/// The light where it covers at least half of a pixel.
std::uint32_t blend(std::uint32_t below, std::uint32_t light) {
  return light >> 24 < 128 ? below : light | 0xff000000u;
}

/// Image, regions and light, in the size of the image.
renderer::Texture pixels_of(const Scene& scene, const Layers& layers) {
  renderer::Texture pixels(scene.camera.width(), scene.camera.height(), 0xff000000u);
  const auto& camera = scene.camera.pixels();
  const auto white = static_cast<unsigned>(white_of(scene.camera));
  if (shows(layers, Layer::image))
    for (std::size_t i = 0; i < camera.size(); ++i)
      pixels.pixels()[i] = 0xff000000u | std::min(255u, camera[i] * 255u / white) * 0x010101u;
  const auto& regions = scene.regions.pixels();
  if (shows(layers, Layer::regions) && regions.size() == camera.size()) {
    const std::vector<Tint> tints(theme::kRegion.begin(), theme::kRegion.end());
    for (std::size_t i = 0; i < camera.size(); ++i)
      pixels.pixels()[i] = tints[regions[i] % kRegions].on(pixels.pixels()[i]);
  }
  const auto& light = scene.light_on_camera.pixels();
  if (shows(layers, Layer::light) && light.size() == camera.size())
    for (std::size_t i = 0; i < camera.size(); ++i)
      pixels.pixels()[i] = blend(pixels.pixels()[i], light[i]);
  return pixels;
}

/// Maps pixels of the image to those of the canvas.
struct ToCanvas {
  glm::vec2 origin;
  float scale;

  glm::vec2 operator()(glm::vec2 px) const { return origin + (px + 0.5f) * scale; }
};

void draw_joints(Canvas& canvas, const ShownHand& hand, ToCanvas to) {
  if (hand.joints_px.size() != renderer::kJointParent.size()) return;
  std::vector<Line> bones;
  for (std::size_t i = 0; i < hand.joints_px.size(); ++i)
    if (const int parent = renderer::kJointParent[i]; parent >= 0)
      bones.emplace_back(to(hand.joints_px[i]),
                         to(hand.joints_px[static_cast<std::size_t>(parent)]));
  canvas.stroke(bones, theme::kJoints.with_alpha(0.75f), 1.4);
  for (const auto joint : hand.joints_px) canvas.disc(to(joint), 2.4, theme::kJoints);
}

void draw_landmarks(Canvas& canvas, const ShownHand& hand, ToCanvas to) {
  for (const auto& mark : hand.landmarks) {
    if (!mark) continue;
    if (mark->sigma_px > 0)
      canvas.ring(to(mark->px), kSigmas * mark->sigma_px * to.scale, theme::kSigma, 1.2);
    canvas.disc(to(mark->px), 2.0, theme::kLandmarks);
  }
}

}  // namespace

void draw_camera(Canvas& canvas, const Box& box, const Scene& scene, const Layers& layers) {
  if (scene.camera.width() < 1) return;
  canvas.image(pixels_of(scene, layers).view(), box);
  const ToCanvas to{{box.x, box.y}, static_cast<float>(box.width / scene.camera.width())};
  canvas.clip(box);
  if (shows(layers, Layer::drawing)) {
    std::vector<Line> edges;
    for (const auto& [from, end] : scene.drawing) edges.emplace_back(to(from), to(end));
    canvas.stroke(edges, theme::kDrawing, 0.6);
  }
  for (const auto& hand : scene.hands) {
    if (shows(layers, Layer::joints)) draw_joints(canvas, hand, to);
    if (shows(layers, Layer::landmarks)) draw_landmarks(canvas, hand, to);
  }
  canvas.unclip();
}

}  // namespace handcast::preview
