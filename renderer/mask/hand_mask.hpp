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
#include "renderer/ladder/corrected.hpp"
#include "renderer/mask/camera_lookup.hpp"
#include "renderer/mask/hint.hpp"
#include "renderer/mask/mask.hpp"
#include "renderer/mask/silhouette.hpp"

namespace handcast::renderer {

using msg::Side;

/// The hands in the camera's image: found where they are expected, and carried on to where they
/// will be when the light arrives. A hand that the image does not show (any more) keeps the mask it
/// had when it was seen last, moved on with it.
class HandMask {
 public:
  /// Where one hand is expected.
  struct Expected {
    Side side;
    std::optional<msg::HandPose>
        then;                         ///< when the image was exposed; empty: it is not searched for
    const Corrected* hand = nullptr;  ///< at the time of the photons
    float presence = 1;               ///< 0: it is given no light
    LandmarkPoints moved_then{},
        moved_now{};  ///< by late registration, at the exposure and at the time of the photons
  };

  HandMask(const config::Mask& settings, const calib::Calibration& calibration);

  /// Finds the hands in the image.
  void find(const TimedImage& camera, std::span<const Expected> hands);

  /// The image shows hand `h`: a joint of it is lit, or at least something as large as a good part
  /// of it where it is expected.
  bool shows(std::size_t h) const { return shown_[h]; }
  /// The edge of all hands in `camera`, the image of the last find().
  Silhouette silhouette(const TimedImage& camera) const {
    return {camera.view, camera.origin_ns, camera_mask_.view(), written_, finder_.threshold()};
  }

  /// The mask in the projector's pixels, each hand moved on; none of a hand without presence. Where
  /// the bounds of two hands overlap, both move as the second does, or as the one that is shown.
  /// Returns the part that has any mask; the view is defined there.
  Rect advance(std::span<const Expected> hands);
  GreyView in_projector() const { return projector_mask_.view(); }

 private:
  /// One hand as it was seen last.
  struct Memory {
    Image<std::uint8_t> mask;    ///< the camera's size, 0 outside `found`
    Rect found;                  ///< empty: never seen
    LandmarkPoints landmarks{};  ///< image px
  };

  LandmarkPoints in_image(LandmarkPoints undistorted_px) const;
  Similarity since_exposure(const Expected& hand) const;
  Similarity since_seen(const Expected& hand) const;
  void clear_camera_mask(int width, int height);
  bool is_shown(const Rect& found, const Rect& before, std::span<const glm::vec2> seeds_px) const;
  void remember(const Expected& hand, const Rect& found);
  Memory& memory_of(Side side) { return memories_[static_cast<std::size_t>(side)]; }
  const Memory& memory_of(Side side) const { return memories_[static_cast<std::size_t>(side)]; }

  config::Mask settings_;
  calib::Calibration calibration_;
  MaskFinder finder_;
  CameraLookup lookup_;
  Image<std::uint8_t> camera_mask_, projector_mask_;
  Rect written_;  ///< of the camera mask; the rest is 0
  std::vector<OwnedHint> owned_hints_;
  std::vector<HandHint> hints_;
  std::vector<Rect>
      found_;  ///< of the hands of find(): holds all that was found of it; empty where nothing was
  std::vector<bool> shown_;                      ///< likewise
  std::array<Memory, msg::kMaxHands> memories_;  ///< by side
};

}  // namespace handcast::renderer
