#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "calib/calibration.hpp"
#include "config/sections/cascade.hpp"
#include "renderer/cascade/reach.hpp"
#include "renderer/cascade/run_map.hpp"
#include "renderer/cascade/similarity.hpp"
#include "renderer/image.hpp"

namespace handcast::renderer {

/// Where a hand is expected in the camera image (image px, distorted): picks its component and cuts the forearm off.
struct HandHint {
  Rect region;                           ///< of the hand, with a margin for what the prediction may be wrong by
  glm::vec2 wrist_px;                    ///< where the hand ends on the forearm (already moved by Mask::forearm_mm)
  glm::vec2 to_elbow;                    ///< unit, from there along the forearm
  std::span<const glm::vec2> inside_px;  ///< points that are on the hand (joints): seeds of its component
  std::span<const Flesh> flesh{};        ///< all that is hand lies in it; empty: the hand may fill its region
  float sure_px = 0, most_px = 0;        ///< what the flesh is usually off by, and at most
};

/// The hand in the camera image: 255 hand, 0 not. Threshold (fixed, or chosen from the image by Otsu on the region's
/// histogram and held between sane bounds), the components that hold the hints' seeds, the forearm cut.
class MaskFinder {
 public:
  explicit MaskFinder(const config::Mask& settings) : settings_(settings) {}

  /// `mask` has the image's size and is written inside the returned rectangle only (the union of the hints' regions, clipped);
  /// no hints, or nothing above the threshold: an empty mask there. A hint none of whose seeds is on something bright takes the
  /// largest bright thing in its region.
  Rect find(GreyView image, std::span<const HandHint> hints, View<std::uint8_t> mask);

  /// Holds all that is lit of one hint's hand in the last mask; empty where nothing is.
  Rect hand_bounds(std::size_t hint) const { return hint < kMostHints ? hand_bounds_[hint] : Rect{}; }
  int threshold() const { return threshold_; }  ///< used for the last image: a pixel above it may be hand

 private:
  static constexpr std::size_t kMostHints = 8;  ///< more are ignored

  void choose(GreyView image, Rect region);
  void bound(std::span<const HandHint> hints, Rect region);
  void close_holes(View<std::uint8_t> mask);

  config::Mask settings_;
  int threshold_ = 0;
  double smooth_threshold_ = 0;  ///< 0: none chosen yet
  Reach reach_;
  RunMap runs_, rest_;  ///< what is bright, and what is not
  std::array<Rect, kMostHints> hand_bounds_{};
};

/// Projector pixel -> camera image pixel (homography and lens distortion), as a table once per calibration.
class CameraLookup {
 public:
  explicit CameraLookup(const calib::Calibration& calibration);
  /// `out(x, y) = mask(then_from_now(camera pixel of projector pixel (x, y)))` for the pixels of `region`; 0 where the camera sees
  /// nothing. `then_from_now` takes a camera pixel back to where the hand's same spot was when the image was exposed.
  void resample(View<const std::uint8_t> mask, Rect region, View<std::uint8_t> out, const Similarity& then_from_now = {}) const;
  /// A bounding rectangle of `camera_region` (image px) in projector px.
  Rect to_projector(Rect camera_region) const;

 private:
  /// Eight by eight projector pixels and where their corners are seen (the right and lower ones a pixel beyond), camera px * 64.
  struct Block {
    int x, y;
    glm::ivec2 top_left, top_right, bottom_left, bottom_right;
  };
  void find_corners(int row, int first, std::vector<glm::ivec2>& corners, const Similarity& then_from_now) const;
  bool resample_uniform(View<const std::uint8_t> mask, const Block& block, View<std::uint8_t> out) const;
  void resample_block(View<const std::uint8_t> mask, const Block& block, Rect part, View<std::uint8_t> out) const;

  int width_ = 0, height_ = 0, columns_ = 0;
  calib::Calibration calibration_;
  std::vector<glm::vec2> table_;  ///< of every 8th projector pixel of every 8th row; bilinear in between
};

}  // namespace handcast::renderer
