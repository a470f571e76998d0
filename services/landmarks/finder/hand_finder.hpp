// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "services/landmarks/finder/bright_hands.hpp"
#include "services/landmarks/finder/hand_tracks.hpp"
#include "services/landmarks/finder/steady_hints.hpp"
#include "services/landmarks/models/landmark_models.hpp"

namespace handcast::landmarks {

/// Finds the hands in a sequence of images. It examines the place of a hand in the last image,
/// moved on with the tracker; otherwise the place that the tracker reports; otherwise, every few
/// images, the places that the palm network finds or, with neither one nor a tracker, the bright
/// parts of the image. If neither is searched, it examines the last place of a hand. One thread, no
/// allocation while hands are followed.
class HandFinder {
 public:
  /// A hand with a smaller presence, or a smaller mean confidence, is not reported.
  /// @{
  static constexpr float kLeastPresence = 0.5f, kLeastConfidence = 0.3f;
  /// @}

  /// Where the poses of the rig, and with them the hints, come from.
  enum class Poses {
    of_a_tracker,
    of_landmarks,  ///< Only images tell where a hand is at first, and which hand it is.
  };

  /// `most_hands`: 1 or 2.
  HandFinder(OpenedModel model, int most_hands, Poses poses = Poses::of_a_tracker)
      : model_(std::move(model)), most_hands_(most_hands), lifts_(poses == Poses::of_landmarks) {}

  /// The hands in the image, valid until the next call. The side of a hand is the tracker's if the
  /// tracker has a hand there, otherwise the model's. Images must come in the order of their times.
  /// `hints_px`: the tracker's joints in the image. Errors: bad_data.
  Result<std::span<const FoundHand>> find(renderer::GreyView image, const Hints& hints_px,
                                          std::int64_t time_ns);

  /// Forgets all images.
  void forget();

  /// The times of the parts of find(), and how often it ran each network.
  struct Times {
    std::int64_t crop_ns = 0;     ///< EstimateTimes::crop_ns of all estimates
    std::int64_t network_ns = 0;  ///< EstimateTimes::network_ns of all estimates
    std::int64_t palm_ns = 0;     ///< the palm network with its crop, or the bright parts
    std::int64_t all_ns = 0;      ///< the whole call
    int model_runs = 0;           ///< runs of the landmark network
    int palm_runs = 0;            ///< runs of the palm network
  };
  /// The times of the last find().
  const Times& times() const { return times_; }

 private:
  bool can_search() const { return model_.palms || lifts_; }
  bool is_found(msg::Side side) const;
  bool has_most() const { return found_.size() >= static_cast<std::size_t>(most_hands_); }
  Result<void> examine(renderer::GreyView image, const HandCandidate& candidate);
  Result<void> examine_either_side(renderer::GreyView image, const Region& region);
  Result<LandmarkEstimate> estimate(renderer::GreyView image, const HandCandidate& candidate,
                                    Region& region);
  Result<LandmarkEstimate> run_model(renderer::GreyView image, const Region& region, msg::Side side,
                                     const std::optional<Points>& hint_px);
  Result<float> left_score_of(renderer::GreyView image, const HandCandidate& candidate,
                              FoundHand& hand);
  float share_of_comparison(FoundHand& hand);
  bool search_is_due(const Hints& hints_px);
  Result<void> search(renderer::GreyView image);
  Result<std::vector<Region>> regions_to_search(renderer::GreyView image);
  Result<std::vector<Region>> search_bright(renderer::GreyView image);
  Result<std::optional<Region>> best_direction(renderer::GreyView image, const BrightHand& bright);
  void drop_duplicate(const Hints& hints_px);
  void settle_sides(const Hints& hints_px);

  static constexpr int kLongAgo = 1'000'000;

  OpenedModel model_;
  int most_hands_;
  bool lifts_;  ///< poses are made from these landmarks
  BrightHands bright_hands_;
  HandTracks tracks_;
  SteadyHints steady_hints_;
  std::vector<FoundHand> found_;
  int since_search_ = kLongAgo, since_side_ = 0;  ///< images
  std::int64_t image_ns_ = 0;
  std::array<std::int64_t, msg::kMaxHands> compared_ns_{};  ///< when sides were compared, by side
  Times times_;
};

}  // namespace handcast::landmarks
