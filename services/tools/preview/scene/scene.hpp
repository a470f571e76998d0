// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ipc/msg/landmarks.hpp"
#include "renderer/base/image.hpp"

namespace handcast::preview {

/// The four regions of the mask and the drawing (docs/method.md#symbols).
enum class Region : std::uint8_t {
  background,  ///< A: neither hand nor drawing
  beside,      ///< B: drawing beside the hand, which the fill darkens; not on the forearm
  unlit,       ///< C: hand without drawing, which the fill lights
  lit,         ///< D: hand with drawing
};
/// Number of regions.
inline constexpr std::size_t kRegions = 4;

/// A detected landmark.
struct ShownLandmark {
  glm::vec2 px{0};     ///< image px, moved with the tracker to the time of the image
  float sigma_px = 0;  ///< standard deviation; 0: not reported
};

/// What tracker and detector say about one hand, at the time of the image.
struct ShownHand {
  msg::Side side = msg::Side::left;  ///< which hand it is
  /// The joints of the tracker in the image, in the order of msg::HandPose; empty: there is none.
  std::vector<glm::vec2> joints_px;
  std::vector<float> depths_m;  ///< of the joints, their distance along the camera's axis
  /// The landmarks; empty for those that the detector did not see.
  std::array<std::optional<ShownLandmark>, msg::kLandmarks> landmarks{};
};

/// The contents of the preview, at the time of one camera image: what is of another time was moved
/// there as the tracker moved. Positions in pixels of the camera's image, (0, 0) is the centre of
/// the top left one.
struct Scene {
  renderer::Image<std::uint8_t> camera;  ///< the image; empty: there is none
  std::uint64_t image_id = 0;            ///< frame_id of the image
  std::int64_t exposure_ns = 0;          ///< duration of its exposure
  std::vector<ShownHand> hands;          ///< at most one per side
  /// The visible edges of the drawn meshes.
  std::vector<std::pair<glm::vec2, glm::vec2>> drawing;
  /// Values of Region, of the size of the image; empty: unknown.
  renderer::Image<std::uint8_t> regions;
  std::array<std::size_t, kRegions> region_px{};  ///< number of pixels of each region
  renderer::Texture light_on_camera;  ///< the light over the image, alpha 0: dark; may be empty
  /// The image of the projector, as bright as its light; empty: there is none.
  renderer::Texture light;
  double brightness = 1;             ///< projector.brightness, which `light` contains
  std::uint64_t light_id = 0;        ///< frame_id of the projector
  bool is_down = false;              ///< the rig is down: there is no light
  std::vector<std::string> missing;  ///< sentences: what is not shown, and why
};

/// A time of a message, limited to the first 100 years of the clock: differences of such times do
/// not overflow.
constexpr std::int64_t sane_ns(std::int64_t time_ns) {
  return std::clamp<std::int64_t>(time_ns, 0, 100LL * 366 * 86'400 * 1'000'000'000);
}

}  // namespace handcast::preview
