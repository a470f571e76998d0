// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "renderer/skin/skinning.hpp"
#include "services/lab/twin/surface.hpp"
#include "tests/services/lab/twin/world.hpp"

namespace handcast::twin {
namespace {

using renderer::Image;

Image<std::uint8_t> picture(const Twin& twin, std::uint64_t k) {
  Image<std::uint8_t> image(720, 540);
  twin.camera_image(k, image.view());
  return image;
}

/// The mask of the hand's mesh alone as seen by the rig's camera, lens distortion included.
Image<std::uint8_t> silhouette(const Twin& twin, Side side, std::int64_t time_ns) {
  const auto rig = calib::reference_rig();
  const auto& mesh = twin.true_hand(side).mesh;
  std::vector<glm::vec3> positions(mesh.vertex_count());
  renderer::skin(mesh, *twin.joints(side, time_ns), positions);
  ScreenVertices screen;
  screen.resize(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const glm::dvec3 p(rig.camera_from_tracker * glm::dvec4(positions[v], 1));
    const glm::dvec2 px = rig.camera.distort(rig.camera.project(p));
    screen.x[v] = static_cast<float>(px.x);
    screen.y[v] = static_cast<float>(px.y);
    screen.inverse_depth[v] = static_cast<float>(1 / p.z);
  }
  Image<std::uint8_t> mask(720, 540);
  Image<float> depth(720, 540);
  for (const auto& triangle : mesh.triangles)
    draw_triangle(screen, triangle, -1, {0, 0, 720, 540}, depth.view(),
                  [&](int x, int y, float, float, float) { mask.at(x, y) = 255; });
  return mask;
}

double iou_above_threshold(const Image<std::uint8_t>& image, const Image<std::uint8_t>& mask,
                           int last_row) {
  int both = 0, either = 0;
  for (int y = 0; y < last_row; ++y)
    for (int x = 0; x < 720; ++x) {
      const bool bright = image.at(x, y) > 35, hand = mask.at(x, y) != 0;
      both += bright && hand;
      either += bright || hand;
    }
  return static_cast<double>(both) / either;
}

double mean_of(const Image<std::uint8_t>& image, int x0, int y0, int width, int height) {
  double sum = 0;
  for (int y = y0; y < y0 + height; ++y)
    for (int x = x0; x < x0 + width; ++x) sum += image.at(x, y);
  return sum / (width * height);
}

TEST(CameraImage, TheHandIsBrightWhereItsMeshIs) {
  for (const char* motion : {"builtin:open_close", "builtin:pinch", "builtin:shake"}) {
    const auto twin = twin_of(rig_with(motion));
    for (const std::uint64_t k : {0, 300, 610}) {
      const auto image = picture(*twin, k);
      const auto time_ns = twin->camera_origin_ns(k);
      const auto wrist = (*twin->landmarks(Side::left, time_ns))[0];
      const auto mask = silhouette(*twin, Side::left, time_ns);
      EXPECT_GT(iou_above_threshold(image, mask, static_cast<int>(wrist.y)), 0.95)
          << motion << " " << k;
      const auto palm = (*twin->landmarks(Side::left, time_ns))[9];
      EXPECT_GT(image.at(static_cast<int>(palm.x), static_cast<int>(palm.y)), 100)
          << motion << " " << k;
      EXPECT_NEAR(mean_of(image, 320, 5, 80, 20), 9, 1.5) << "background";
    }
  }
}

TEST(CameraImage, ForearmAndSleeveReachTheLowerEdge) {
  auto rig = rig_with("builtin:still");
  rig.twin.image.sleeve_mm = 40;
  const auto twin = twin_of(rig);
  const auto image = picture(*twin, 0);
  const auto wrist = (*twin->landmarks(Side::left, 0))[0];
  const auto x = static_cast<int>(wrist.x);
  const double arm = mean_of(image, x - 10, static_cast<int>(wrist.y) + 20, 20, 10),
               sleeve = mean_of(image, x - 10, 525, 20, 10);
  EXPECT_GT(arm, 90);
  EXPECT_GT(sleeve, arm * 1.15) << "the sleeve is brighter than skin";

  rig.twin.image.sleeve_mm = 400;
  EXPECT_NEAR(mean_of(picture(*twin_of(rig), 0), x - 10, 525, 20, 10), arm, 0.25 * arm)
      << "no sleeve: skin down to the edge";
}

TEST(CameraImage, NoiseHasTheAskedDeviationAndChangesFromFrameToFrame) {
  auto rig = rig_with("builtin:still");
  rig.twin.image.background = 50;
  rig.twin.image.noise = 3;
  const auto twin = twin_of(rig);
  const auto first = picture(*twin, 0), second = picture(*twin, 1);
  double square = 0, product = 0;
  int count = 0;
  for (int y = 2; y < 90; ++y)
    for (int x = 300; x < 420; ++x, ++count) {
      const double clean =
          (mean_of(first, x - 2, y - 2, 5, 5) + mean_of(second, x - 2, y - 2, 5, 5)) / 2;
      square += (first.at(x, y) - clean) * (first.at(x, y) - clean);
      product += (first.at(x, y) - clean) * (second.at(x, y) - clean);
    }
  EXPECT_NEAR(std::sqrt(square / count), 3, 0.3);
  EXPECT_LT(std::abs(product / square), 0.08);
  EXPECT_EQ(first.pixels(), picture(*twin, 0).pixels()) << "the same frame is the same picture";
}

TEST(CameraImage, TheExposureBlursAMovingHand) {
  auto rig = rig_with("builtin:shake");
  rig.twin.image.noise = 0;
  rig.camera.exposure_ms = 20;
  const auto soft_pixels = [&](int blur_samples) {
    rig.twin.image.blur_samples = blur_samples;
    const auto image = picture(*twin_of(rig), 1050);
    int soft = 0;
    for (const std::uint8_t grey : image.pixels()) soft += grey > 15 && grey < 50;
    return soft;
  };
  EXPECT_GT(soft_pixels(8), 4 * soft_pixels(1) + 1000);
}

TEST(CameraImage, TwoHandsAreBothThere) {
  const auto twin = twin_of(rig_with("builtin:two_hands"));
  const auto image = picture(*twin, 100);
  for (const Side side : {Side::left, Side::right}) {
    const auto palm = (*twin->landmarks(side, twin->camera_origin_ns(100)))[9];
    EXPECT_GT(image.at(static_cast<int>(palm.x), static_cast<int>(palm.y)), 100);
  }
}

TEST(Camera, TheSecondViewSeesTheSameWorldFromItsOwnPlace) {
  config::Rig rig;
  auto cameras = calib::reference_rig();
  glm::dmat4 from_camera(1);
  from_camera[3].x = -0.05;
  cameras.camera2 = calib::SecondCamera{{}, cameras.camera, from_camera};
  const auto first = Twin::create(rig, cameras).value(),
             second = Twin::create(rig, cameras, config::Viewpoint::second).value();
  const auto here = first->joints(Side::left, 0).value(),
             there = second->joints(Side::left, 0).value();
  EXPECT_EQ(here[10], there[10]) << "one hand";
  const auto seen = first->landmarks(Side::left, 0).value(),
             beside = second->landmarks(Side::left, 0).value();
  const double depth_m = (cameras.camera_from_tracker * glm::dvec4(glm::dvec3(here[12][3]), 1)).z;
  EXPECT_NEAR(seen[9].x - beside[9].x, 0.05 * cameras.camera.fx_px / depth_m, 0.1);
  EXPECT_NEAR(seen[9].y, beside[9].y, 0.1);
  const auto image = picture(*first, 3), other = picture(*second, 3);
  EXPECT_EQ(first->camera_stamp_ns(3), second->camera_stamp_ns(3)) << "triggered together";
  int moved = 0, same = 0;
  const int step_px = static_cast<int>(std::lround(seen[9].x - beside[9].x));
  for (int y = 0; y < 540; ++y)
    for (int x = step_px; x < 720; ++x)
      if (image.at(x, y) > 100) {
        moved += other.at(x - step_px, y) > 100;
        same += other.at(x, y) > 100;
      }
  EXPECT_GT(moved, same) << "the picture of the hand is where the second camera has it";
}

}  // namespace
}  // namespace handcast::twin
