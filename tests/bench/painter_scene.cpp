// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/painter_scene.hpp"

#include <stdexcept>

#include "renderer/draw/cpu/cpu_painter.hpp"
#include "tests/renderer/draw/bent_grid.hpp"
#include "tests/renderer/hand_pose.hpp"

namespace handcast::bench {
namespace {

using namespace renderer;

constexpr double kDistance_m = 0.73;
constexpr glm::ivec2 kMaskMoved_px{12, 3};

/// The reference rig with a projector of this size, and tracker space such that a hand at rest is
/// seen from its back, fingers up.
calib::Calibration rig_of(int width_px, int height_px) {
  calib::Calibration calibration = calib::reference_rig();
  const double scale_x = static_cast<double>(width_px) / calibration.projector.width_px,
               scale_y = static_cast<double>(height_px) / calibration.projector.height_px;
  calibration.projector.from_camera =
      glm::dmat3(scale_x, 0, 0, 0, scale_y, 0, 0, 0, 1) * calibration.projector.from_camera;
  calibration.projector.width_px = width_px;
  calibration.projector.height_px = height_px;
  calibration.camera_from_tracker =
      glm::dmat4({1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 0.09, kDistance_m, 1});
  return calibration;
}

Texture fine_pattern() {
  Texture texture(1024, 640);
  for (int y = 0; y < texture.height(); ++y)
    for (int x = 0; x < texture.width(); ++x)
      texture.at(x, y) =
          0xff000000u | static_cast<std::uint32_t>(x * 65'793 + y * 2'777) % 0xffffffu;
  return texture;
}

}  // namespace

PainterScene::PainterScene(std::string its_name, int hands, const renderer::samples::Pose& pose,
                           int width_px, int height_px, bool smooth)
    : name(std::move(its_name)), picture_(fine_pattern(), smooth) {
  const calib::Calibration calibration = rig_of(width_px, height_px);
  place_hand(Side::left, pose, hands == 1 ? 0 : -0.085f, calibration);
  if (hands > 1) place_hand(Side::right, pose, 0.085f, calibration);
  for (const auto& hand : hands_)
    drawn.push_back({&hand->surface.mesh(), picture_.view(), hand->skinned.projected_px,
                     hand->skinned.depth_m, hand->skinned.light, hand->revision, hand->revision});
  make_mask(width_px, height_px);
  grid = renderer::test::bent_grid({0, 0, width_px, height_px});
}

void PainterScene::place_hand(Side side, const renderer::samples::Pose& pose, float aside_m,
                              const calib::Calibration& calibration) {
  auto mesh = load_hand_or_default({}, side);
  if (!mesh) throw std::runtime_error(mesh.error().what);
  const msg::HandPose reported = pose_of(side, posed(*mesh, pose), {aside_m, 0, 0});
  Hand& hand =
      *hands_.emplace_back(std::make_unique<Hand>(Hand{HandSurface(std::move(*mesh), 14), {}}));
  hand.skinned = hand.surface.pose(reported, {.fit = false}, calibration, 0.5f);
  region = region.joined(hand.surface.bounds(hand.skinned.projected_px));
}

void PainterScene::make_mask(int width_px, int height_px) {
  const auto painter = make_cpu_painter(width_px, height_px);
  painter->draw(drawn, {0, 0, width_px, height_px});
  mask = Image<std::uint8_t>(width_px, height_px);
  for (int y = kMaskMoved_px.y; y < height_px; ++y)
    for (int x = kMaskMoved_px.x; x < width_px; ++x)
      mask.at(x, y) = painter->surface().at(x - kMaskMoved_px.x, y - kMaskMoved_px.y) ? 255 : 0;
  region =
      Rect{region.x0, region.y0, region.x1 + kMaskMoved_px.x, region.y1 + kMaskMoved_px.y}.within(
          width_px, height_px);
}

}  // namespace handcast::bench
