#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "calib/calibration.hpp"
#include "config/sections/cascade.hpp"
#include "renderer/image.hpp"

namespace handcast::renderer {

/// Where a hand is expected in the camera image (image px, distorted): picks its component and cuts the forearm off.
struct HandHint {
  Rect region;               ///< of the hand, with a margin for what the prediction may be wrong by
  glm::vec2 wrist_px;        ///< where the hand ends on the forearm (already moved by Mask::forearm_mm)
  glm::vec2 to_elbow;        ///< unit, from there along the forearm
  std::span<const glm::vec2> inside_px;  ///< points that are on the hand (joints): seeds of its component
};

/// The hand in the camera image: 255 hand, 0 not. Threshold (fixed, or chosen from the image by Otsu on the region's
/// histogram and held between sane bounds), the components that hold the hints' seeds, the forearm cut.
class MaskFinder {
 public:
  explicit MaskFinder(const config::Mask& settings) : settings_(settings) {}

  /// `mask` has the image's size and is written inside the returned rectangle only (the union of the hints' regions, clipped);
  /// no hints, or nothing above the threshold: an empty mask there.
  Rect find(GreyView image, std::span<const HandHint> hints, View<std::uint8_t> mask);

  int threshold() const { return threshold_; }  ///< used for the last image

 private:
  config::Mask settings_;
  int threshold_ = 0;
};

/// Projector pixel -> camera image pixel (homography and lens distortion), as a table once per calibration.
class CameraLookup {
 public:
  explicit CameraLookup(const calib::Calibration& calibration);
  /// `out(x, y) = mask(camera pixel of projector pixel (x, y))` for the pixels of `region`; 0 where the camera sees nothing.
  void resample(View<const std::uint8_t> mask, Rect region, View<std::uint8_t> out) const;
  /// A bounding rectangle of `camera_region` (image px) in projector px, and the inverse.
  Rect to_projector(Rect camera_region) const;
  Rect to_camera(Rect projector_region) const;

 private:
  int width_ = 0, height_ = 0;
  calib::Calibration calibration_;
  std::vector<std::int16_t> table_;  ///< camera x and y of every 8th projector pixel of a row, 1/16 px
};

}  // namespace handcast::renderer
