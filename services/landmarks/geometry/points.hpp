// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <optional>

#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"

namespace handcast::landmarks {

/// The 21 landmarks of a hand in pixels, in MediaPipe's order; (0, 0) is the centre of the top-left
/// pixel, x points right, y down.
using Points = std::array<glm::vec2, msg::kLandmarks>;

/// The tracker's joints in a camera image, by msg::Side; empty for a hand that it does not see.
using Hints = std::array<std::optional<Points>, msg::kMaxHands>;

/// The mean of the points.
glm::vec2 centre_of(const Points& points_px);
/// The distance from the wrist to the middle finger's knuckle.
float palm_length_px(const Points& points_px);
/// The mean distance between points of the same number.
float distance_px(const Points& a, const Points& b);
/// The points, each shifted by `by_px`.
Points shifted(Points points_px, glm::vec2 by_px);
/// True if all coordinates are finite.
bool is_finite(const Points& points_px);

}  // namespace handcast::landmarks
