// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"
#include "services/landmarks/crop/crop.hpp"
#include "services/landmarks/geometry/points.hpp"
#include "services/landmarks/geometry/region.hpp"
#include "services/landmarks/inference/network.hpp"

namespace handcast::landmarks {

// The regions that MediaPipe Hands' landmark network was trained with.

/// The region around landmarks of the image before, or around the tracker's joints: the box of
/// wrist, thumb, knuckles and middle joints, twice as large (MediaPipe's
/// hand_landmark_landmarks_to_roi).
Region mediapipe_region_of_landmarks(const Points& points_px);

/// The region of a palm: from the centre and the longer side of its box and the line from the wrist
/// to the middle knuckle (MediaPipe's palm_detection_detection_to_roi). All in image pixels.
Region mediapipe_region_of_palm(glm::vec2 centre_px, glm::vec2 extent_px, glm::vec2 wrist_px,
                                glm::vec2 middle_knuckle_px);

// The output of MediaPipe Hands' palm network: single-shot detection relative to anchors.

/// A palm in the square image that the network was given. Places and lengths are fractions of its
/// side, 0..1 from the upper left corner.
struct Palm {
  /// Wrist; knuckles of index, middle, ring and little finger; lowest joint and knuckle of the
  /// thumb.
  static constexpr int kPoints = 7;
  float score = 0;  ///< 0..1
  /// Its box.
  /// @{
  glm::vec2 centre{0}, extent{0};
  /// @}
  std::array<glm::vec2, kPoints> points{};  ///< its points
};

inline constexpr int kPalmSide_px = 192;                   ///< side of the network's input
inline constexpr int kPalmAnchors = 2016;                  ///< number of anchors
inline constexpr int kPalmValues = 4 + 2 * Palm::kPoints;  ///< values per anchor

/// The anchors: the centres of 24 x 24 cells, each twice, then of 12 x 12 cells, each six times.
std::span<const glm::vec2> palm_anchors();

/// Decodes the network's outputs: `boxes`, kPalmAnchors x kPalmValues, and `logits`, kPalmAnchors.
/// Candidates that overlap are merged, weighted by score (MediaPipe's weighted suppression). The
/// highest score comes first; none is below `least_score`.
std::vector<Palm> decode_palms(std::span<const float> boxes, std::span<const float> logits,
                               float least_score = 0.5f);

/// The region in which to estimate the landmarks of a palm that was found in the region `shown`.
Region region_of_palm(const Palm& palm, const Region& shown);

/// MediaPipe Hands' palm network (lite), which searches a whole image for palms. One thread.
class MediapipePalmNetwork {
 public:
  /// Errors: those of open_mediapipe_network().
  static Result<MediapipePalmNetwork> open(const std::filesystem::path& file);

  /// The regions of the palms in the image, the most certain first. Errors: bad_data.
  Result<std::vector<Region>> search(renderer::GreyView image);

 private:
  explicit MediapipePalmNetwork(std::unique_ptr<Network> network) : network_(std::move(network)) {}

  std::unique_ptr<Network> network_;
  Crop crop_{kPalmSide_px};
};

}  // namespace handcast::landmarks
