// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "calib/calibration.hpp"
#include "config/sections/cascade.hpp"
#include "renderer/base/image.hpp"
#include "renderer/mask/camera_lookup.hpp"
#include "renderer/mask/hint.hpp"
#include "renderer/mask/mask.hpp"
#include "renderer/mask/nearness_grid.hpp"
#include "renderer/mask/silhouette.hpp"
#include "renderer/predict/projected_pose.hpp"

namespace handcast::renderer {

using msg::Side;

/// Step "mask" and its state: the masks of the hands, found in the camera's image where the hands
/// are expected, and moved to where the hands will be at the target time. A hand that the image no
/// longer shows keeps the mask it had when it was last shown, moved with it. See
/// `docs/method.md#mask`. At most msg::kMaxHands hands. One thread.
class HandMask {
 public:
  /// A hand to be found in an image.
  struct Sought {
    Side side;                          ///< which hand it is
    std::optional<ProjectedPose> then;  ///< by the tracker at the exposure; empty: it is not sought
    LandmarkPoints offset_px{};         ///< Q̂ - P
    bool has_landmarks = false;         ///< the offset is that of landmarks, not 0
  };
  /// A hand at the target time.
  struct Moved {
    float presence = 1;          ///< share of its light; 0: it gets no mask
    LandmarkPoints tracker{};    ///< P
    LandmarkPoints landmarks{};  ///< Q̂ before registration
    /// Displacement of its landmarks by late registration, at the exposure and at the target time.
    /// @{
    LandmarkPoints moved_then{}, moved_now{};
    /// @}
    /// Its drawn vertices, projector px, and their depths: needed if camera and projector are not
    /// coaxial.
    /// @{
    std::span<const glm::vec2> projected_px{};
    std::span<const float> depths_m{};
    /// @}
  };

  /// Without an image. Copies the settings and the calibration. `smooth`: the mask in the projector
  /// has shares of pixels at its edges.
  HandMask(const config::Mask& settings, const calib::Calibration& calibration,
           bool smooth = false);
  /// Uses other settings for the images from now on.
  void adjust(const config::Mask& settings) {
    settings_ = settings;
    finder_.adjust(settings);
  }

  /// Masks for another projector with an image of the same size from now on.
  void aim(const calib::ProjectorModel& projector) {
    calibration_.projector = projector;
    lookup_.aim(projector);
  }

  /// Finds the hands in an image. In the image of the last call, hands that have hardly moved are
  /// not searched again.
  void find(const TimedImage& camera, std::span<const Sought> hands);

  /// True if the image of the last find() shows its hand `h`: one of its joints is lit, or the
  /// bounds of its mask have at least a quarter of the area that they had when the hand was last
  /// shown.
  bool shows(std::size_t h) const { return found_[h].is_shown; }
  /// The masks in `camera`, which must be the image of the last find(). Valid until the next
  /// find().
  Silhouette silhouette(const TimedImage& camera) const {
    return {camera.view, camera.origin_ns,    camera_mask_.view(),
            written_,    finder_.threshold(), finder_.local_threshold()};
  }

  /// Moves the masks of the last find() to the target time, in projector pixels. `hands`: those of
  /// find(), in the same order. Returns the region that contains the masks. Where the bounds of two
  /// hands overlap, both masks move as the second hand does, or as the one that is shown.
  Rect advance(std::span<const Moved> hands);
  /// The masks of the last advance(), in the projector's size: 255 hand, 0 not, or the
  /// share of the pixel that is hand. Defined inside the returned region only.
  GreyView in_projector() const { return projector_mask_.view(); }

 private:
  /// One hand of find().
  struct Found {
    Side side;
    std::optional<LandmarkPoints> then;  ///< P at the exposure
    Rect bounds;                         ///< of its mask; empty if there is none
    bool is_shown = false;               ///< see shows()
  };
  /// One hand as it was last shown.
  struct Memory {
    Image<std::uint8_t> mask;    ///< of the camera's size, 0 outside `found`
    Rect found;                  ///< empty if it was never shown
    LandmarkPoints landmarks{};  ///< image px
  };

  bool was_found(const TimedImage& camera, std::span<const Sought> hands) const;
  LandmarkPoints in_image(LandmarkPoints undistorted_px) const;
  Similarity since_exposure(const Found& found, const Moved& hand) const;
  Similarity since_seen(const Found& found, const Moved& hand) const;
  Rect region_of(std::size_t h, const Moved& hand, const Rect& image_region);
  void set_size(int width, int height);
  bool is_shown(const Rect& found, const Rect& before, std::span<const glm::vec2> seeds_px) const;
  void remember(const Sought& hand, const Rect& found);
  Memory& memory_of(Side side) { return memories_[static_cast<std::size_t>(side)]; }
  const Memory& memory_of(Side side) const { return memories_[static_cast<std::size_t>(side)]; }

  config::Mask settings_;
  calib::Calibration calibration_;
  MaskFinder finder_;
  CameraLookup lookup_;
  std::array<NearnessGrid, msg::kMaxHands> nearness_;  ///< by hand of advance()
  Image<std::uint8_t> camera_mask_, projector_mask_;
  Rect written_;                ///< part of camera_mask_ that is not 0
  TimedImage image_;            ///< of the last search, only to be compared
  std::vector<Sought> sought_;  ///< by the last search
  std::vector<OwnedHint> owned_hints_;
  std::vector<HandHint> hints_;
  std::vector<Found> found_;
  std::array<Memory, msg::kMaxHands> memories_;  ///< by side
};

}  // namespace handcast::renderer
