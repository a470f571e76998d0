// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <vector>

#include "services/lab/twin/held_board.hpp"
#include "tests/services/lab/twin/world.hpp"

/// A twin in front of whose camera a board is held.
namespace handcast::twin {

using renderer::Image;

inline constexpr int kColumns = 10, kRows = 7;
inline constexpr double kSquare_m = 0.025;

/// A checkerboard with a margin of half a square. Its origin is the corner of the first four
/// squares.
inline FlatPicture checkerboard(int px_per_square) {
  FlatPicture picture;
  picture.width_px = (kColumns + 1) * px_per_square;
  picture.height_px = (kRows + 1) * px_per_square;
  picture.metres_per_px = kSquare_m / px_per_square;
  picture.origin_px = glm::dvec2(1.5 * px_per_square - 0.5);
  for (int y = 0; y < picture.height_px; ++y)
    for (int x = 0; x < picture.width_px; ++x) {
      const int column = (2 * x / px_per_square + 1) / 2 - 1,
                row = (2 * y / px_per_square + 1) / 2 - 1;
      const bool margin = column < 0 || row < 0 || column >= kColumns || row >= kRows;
      picture.pixels.push_back(!margin && (column + row) % 2 == 0 ? 15 : 240);
    }
  return picture;
}

/// White paper of the same size and place.
inline FlatPicture blank() {
  auto picture = checkerboard(10);
  std::fill(picture.pixels.begin(), picture.pixels.end(), std::uint8_t{255});
  return picture;
}

inline config::Rig board_rig(double leak = 0) {
  auto rig = rig_with("builtin:open_close");
  rig.twin.prop.kind = config::TwinPropKind::board;
  rig.twin.image.noise = 0;
  rig.twin.image.leak = leak;
  return rig;
}

inline std::unique_ptr<Twin> twin_with(const config::Rig& rig, const FlatPicture& picture) {
  auto twin = twin_of(rig);
  const auto shown = twin->show_board(picture);
  EXPECT_TRUE(shown) << shown.error().what;
  return twin;
}

/// The camera frame in the middle of the hold at a place.
inline std::uint64_t frame_at(const config::Rig& rig, int place) {
  const double seconds =
      place * (rig.twin.prop.hold_s + HeldBoard::kMove_s) + rig.twin.prop.hold_s / 2;
  return static_cast<std::uint64_t>(seconds * rig.camera.rate_hz);
}

inline Image<std::uint8_t> shot(const Twin& twin, std::uint64_t k) {
  Image<std::uint8_t> image(720, 540);
  twin.camera_image(k, image.view());
  return image;
}

/// The grey levels of a projector image.
struct Picture {
  std::vector<std::uint8_t> grey = std::vector<std::uint8_t>(1024 * 768);
  Light light() const { return {grey.data(), 1024, 768}; }
};

/// A bright square around a projector pixel.
inline Picture spot(int x_px, int y_px, int reach_px) {
  Picture picture;
  for (int y = y_px - reach_px; y <= y_px + reach_px; ++y)
    for (int x = x_px - reach_px; x <= x_px + reach_px; ++x) picture.grey[y * 1024 + x] = 255;
  return picture;
}

inline Image<std::uint8_t> lit_shot(const Twin& twin, std::uint64_t k, const Picture& picture) {
  Image<std::uint8_t> image(720, 540);
  twin.camera_image(k, picture.light(), image.view());
  return image;
}

inline glm::dvec3 ray_of(const Twin& twin, const glm::dvec2& image_px) {
  const auto& camera = twin.geometry().calibration().camera;
  return glm::inverse(camera.matrix()) * glm::dvec3(camera.undistort(image_px), 1);
}

/// The point of the board that a pixel of the true camera sees, camera space.
inline glm::dvec3 on_board_m(const Twin& twin, const glm::dmat4& pose, const glm::dvec2& image_px) {
  const auto ray = ray_of(twin, image_px);
  return ray *
         (glm::dot(glm::dvec3(pose[2]), glm::dvec3(pose[3])) / glm::dot(glm::dvec3(pose[2]), ray));
}

/// Where a place on the board is in the image.
inline glm::dvec2 in_image_px(const Twin& twin, std::uint64_t k, const glm::dvec2& board_m) {
  const auto& camera = twin.geometry().calibration().camera;
  const auto pose = *twin.board_pose(twin.camera_origin_ns(k));
  return camera.distort(camera.project(glm::dvec3(pose * glm::dvec4(board_m, 0, 1))));
}

}  // namespace handcast::twin
