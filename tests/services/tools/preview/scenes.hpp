// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/owned.hpp"
#include "ipc/msg/projection.hpp"
#include "services/tools/preview/scene/scene_maker.hpp"
#include "tests/milliseconds.hpp"

/// Messages and worlds for the tests of the preview.
namespace handcast::preview::test {

inline constexpr std::int64_t kImage_ns = 1000 * kMs;
inline constexpr double kDistance_m = 0.5;  ///< of the hands from the camera

/// The reference rig, whose hands are squares of four vertices.
World world();
/// An image of the size of the world's camera, exposed at `origin_ns`.
msg::Owned<msg::CameraFrame> frame(std::int64_t origin_ns = kImage_ns, std::uint8_t grey = 10);
/// Light of the size of the world's projector, with a lit region of 64 x 64 px at (100, 100).
msg::Owned<msg::Projection> light(std::int64_t target_ns = kImage_ns);
/// The vertices of the left hand at the corners of a rectangle of projector px.
void draw_square(msg::Projection& projection, glm::vec2 low, glm::vec2 high);

/// A tracker sample with a left hand whose middle is seen at `image_px`. Its joints are on a grid
/// of 20 px.
msg::HandPoses poses(std::int64_t origin_ns, glm::dvec2 image_px);
/// A detection of a left hand; all landmarks at `px`.
msg::Landmarks landmarks(std::int64_t origin_ns, glm::vec2 px, float sigma_px = 2);

}  // namespace handcast::preview::test
