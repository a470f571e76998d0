// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "config/sections/cascade.hpp"
#include "renderer/base/image.hpp"
#include "renderer/base/landmark_points.hpp"
#include "renderer/mask/local_threshold.hpp"
#include "renderer/mask/run_map.hpp"

namespace handcast::renderer {

/// The flesh around one bone in the image: a disc at either end and the convex area between them.
struct Capsule {
  /// Centres of the discs, image px.
  /// @{
  glm::vec2 from_px, to_px;
  /// @}
  /// Radii of the discs.
  /// @{
  float from_radius_px, to_radius_px;
  /// @}
};

/// Capsules of a hand: its bones, and the wrist.
inline constexpr std::size_t kCapsules = 25;

/// Pixels [x0, x1) of a row.
struct RowSpan {
  /// First column, and one past the last.
  /// @{
  int x0, x1;
  /// @}
};

/// The parts of each row of a region that a union of shapes covers. Each group of eight rows shares
/// the spans at its middle.
class RowSpans {
 public:
  /// Spans per row, at most; more are ignored.
  static constexpr std::size_t kMost = msg::kMaxHands * kCapsules;

  /// Allocates the memory for regions of this height in pixels.
  void reserve(int height);
  /// Removes all shapes.
  void reset(Rect region);
  /// Adds the capsule of a bone, grown by `margin_px`.
  void add(const Capsule& capsule, float margin_px);
  /// Adds a rectangle.
  void add(Rect rect);
  /// Sorts and joins the spans of each row: call it after the last add() and before row().
  void settle();

  /// The spans of row `y` of the region, from left to right, with gaps between them.
  std::span<const RowSpan> row(int y) const;

 private:
  void add(int band, float x0, float x1);

  Rect region_;
  std::vector<RowSpan> spans_;  ///< kMost entries per group of rows
  std::vector<int> counts_;     ///< entries in use, per group of rows
};

/// Bounds of the hands in the image, from the flesh around their bones. The inner bound is where
/// the hands are if the bones are where they are expected; the outer bound is where they may be if
/// the bones are off. Lit pixels between the two are hand, unless they continue beyond the outer
/// bound: then something else is lit behind the hand, or the image is too bright, and only the
/// inner bound counts. If no more than 85 % of the inner bound is lit, the bones are off, and
/// everything up to the outer bound counts. One thread.
class HandMaskBounds {
 public:
  /// The line between a hand and its forearm. Lit pixels beyond it are the arm and do not count as
  /// continuing beyond the outer bound.
  struct Wrist {
    glm::vec2 px;        ///< a point of the line, image px
    glm::vec2 to_elbow;  ///< unit, at right angles to the line
  };

  /// Allocates the memory for images of this size in pixels.
  void reserve(int width, int height);
  /// Removes all hands. `region`: image px.
  void reset(Rect region);
  /// Adds a hand by its capsules, which grow by `sure_px` for the inner and by `most_px` for the
  /// outer bound.
  void add(std::span<const Capsule> capsules, float sure_px, float most_px, const Wrist& wrist);
  /// Adds a rectangle that a hand may fill, to both bounds.
  void add(Rect rect);
  /// Ends the additions: call it after the last add() and before the functions below.
  void settle();

  /// The part of row `y` inside the outer bound, and 2 px on either side.
  RowSpan row(int y) const;
  /// True if the whole run is inside the inner bound.
  bool surely_holds(const RunMap::Run& run) const;
  /// Sets the pixels of `mask` (0 or 255) to 0 that cannot be hand.
  void confine(View<std::uint8_t> mask);

 private:
  void read_around(View<const std::uint8_t> mask);
  double filled(View<const std::uint8_t> mask) const;
  bool goes_beyond(const RunMap::Run& run) const;

  Rect region_;
  RowSpans sure_, most_;
  std::vector<Wrist> wrists_;
  /// Lit parts outside the inner bound. Owner 0: the part continues beyond the outer bound.
  RunMap around_;
};

/// Where a hand is expected in the camera image (image px, distorted). Selects its connected part
/// and cuts the forearm off. The spans are borrowed.
struct HandHint {
  Rect region;         ///< bounds of the hand, with a margin for errors of the prediction
  glm::vec2 wrist_px;  ///< where the hand ends on the forearm, config::Mask::forearm_mm included
  glm::vec2 to_elbow;  ///< unit, from `wrist_px` along the forearm
  /// Points on the hand (its joints): the seeds of its connected part. At most kLandmarks.
  std::span<const glm::vec2> inside_px;
  /// Contains the whole hand. Empty: the hand may fill its region.
  std::span<const Capsule> capsules{};
  /// Usual and largest error of the capsules.
  /// @{
  float sure_px = 0, most_px = 0;
  /// @}
};

/// Finds the hands in a camera image: pixels above a threshold, inside the bounds of the hands, in
/// a connected part that contains a seed, without the forearm, small holes closed. The threshold is
/// fixed or chosen from each image (choose_threshold()), limited and smoothed, and then follows the
/// light over the hand (LocalThreshold). One thread.
class MaskFinder {
 public:
  /// Copies the settings.
  explicit MaskFinder(const config::Mask& settings) : settings_(settings) {}
  /// Uses other settings from now on.
  void adjust(const config::Mask& settings) { settings_ = settings; }

  /// Allocates the memory for images of this size in pixels.
  void reserve(int width, int height);
  /// Writes the mask of all hands: 255 hand, 0 not. `mask` has the size of the image; only the
  /// returned rectangle is written, the joined regions of the hints, clipped to the image. A hint
  /// without a seed on a bright part takes the largest bright part in its region. At most
  /// msg::kMaxHands hints are used.
  Rect find(GreyView image, std::span<const HandHint> hints, View<std::uint8_t> mask);

  /// Bounds of the hand of one hint in the last mask; empty if there is none.
  Rect hand_bounds(std::size_t hint) const {
    return hint < hand_bounds_.size() ? hand_bounds_[hint] : Rect{};
  }
  /// The threshold of the last image. A chosen one is the middle of those of the pixels.
  int threshold() const { return threshold_; }
  /// The thresholds of the pixels in the last image; null if one holds for all.
  const LocalThreshold* local_threshold() const {
    return settings_.threshold <= 0 ? &local_ : nullptr;
  }

 private:
  void choose(GreyView image, Rect region);
  void binarise(GreyView image, Rect region, View<std::uint8_t> mask);
  void bound(std::span<const HandHint> hints, Rect region);
  void close_holes(View<std::uint8_t> mask);

  config::Mask settings_;
  int threshold_ = 0;
  double smooth_threshold_ = 0;  ///< 0 until one is chosen
  LocalThreshold local_;
  HandMaskBounds reach_;
  RunMap runs_, rest_;  ///< the bright and the dark parts
  std::array<Rect, msg::kMaxHands> hand_bounds_{};
};

}  // namespace handcast::renderer
