// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/landmarks/finder/confidence.hpp"
#include "services/landmarks/finder/hand_network.hpp"

namespace handcast::landmarks {

/// Where a tracker's joints lie in an image, by msg::Side; nothing where it sees no such hand.
using Hints = std::array<std::optional<Points>, msg::kMaxHands>;

struct FoundHand {
  msg::Side side = msg::Side::left;
  float presence = 0;                             ///< 0..1
  Points points_px{};                             ///< in the image, as the network defines them
  Region region;                                  ///< where it was looked for
  std::array<float, msg::kLandmarks> sigma_px{};  ///< standard deviation per axis; 0: not known
  Confidences confidences{};                      ///< 0..1
};

/// Finds the hands of one image after another. Looks where they surely were in the last image,
/// moved on with the tracker; else where the tracker has them; else, every few images, where the
/// palm network finds one, or without it where a hand was last. One thread, no allocation while
/// hands are followed.
class HandFinder {
 public:
  static constexpr float kLeastPresence = 0.5f;
  static constexpr float kLeastConfidence =
      0.3f;  ///< mean of the landmarks': what is less is no hand
  static constexpr float kSteadyConfidence =
      0.6f;  ///< the same: what is less may lie beside the hand
  static constexpr float kSureConfidence = 0.5f;  ///< of one landmark

  /// `most_hands`: 1 or 2.
  HandFinder(std::unique_ptr<LandmarkModel> hand, std::optional<PalmNetwork> palm, int most_hands)
      : hand_(std::move(hand)), palm_(std::move(palm)), most_hands_(most_hands) {}

  /// MediaPipe Hands: both networks. Errors (bad_config): a model file is missing or not the right
  /// one.
  static Result<HandFinder> open(const std::string& backend, const std::filesystem::path& models,
                                 int most_hands);

  /// Hands of at least kLeastPresence and kLeastConfidence, valid until the next call. A side is
  /// the tracker's where it has a hand there, else the network's. Images must be given in the order
  /// of their times. Errors: bad_data.
  Result<std::span<const FoundHand>> find(renderer::GreyView image, const Hints& hints_px,
                                          std::int64_t time_ns);

  /// As if it had never seen an image.
  void forget();

  struct Times {
    std::int64_t crop_ns = 0, network_ns = 0, palm_ns = 0, all_ns = 0;
    int looks = 0, searches = 0;  ///< how often each network ran
  };
  const Times& times() const { return times_; }  ///< of the last find()

 private:
  /// A hand that is being followed.
  struct Track {
    msg::Side side;
    Points points_px;
    Points around_px;  ///< where to look next: the same, but for unsure points the tracker's where
                       ///< there is one
    std::optional<Points> hint_px;  ///< the tracker's at that time
    float left_score;               ///< its running mean
    std::int64_t seen_ns;
    bool steady;  ///< found in the last image, and surely: the next one is looked at around these
                  ///< points
  };
  struct Candidate {
    msg::Side side;
    Region region;
    std::optional<Points> hint_px;
    bool is_followed = false;  ///< of a steady track
    float left_score = -1;     ///< before this image; negative: not known
  };

  void choose_candidates(const Hints& hints_px);
  std::optional<std::size_t> track_of(msg::Side side, const Points& hint_px) const;
  /// The hint, where it can be of the hand at these points.
  std::optional<Points> if_near(const std::optional<Points>& hint_px,
                                const Points& points_px) const;
  bool is_found(msg::Side side) const;
  Result<void> look(renderer::GreyView image, const Candidate& candidate);
  Result<LandmarkModel::Seen> look_at(renderer::GreyView image, const Candidate& candidate,
                                      Region& region);
  Result<LandmarkModel::Seen> look_once(renderer::GreyView image, const Region& region,
                                        msg::Side side, const std::optional<Points>& hint_px);
  Result<float> left_score_of(renderer::GreyView image, const Candidate& candidate,
                              const FoundHand& hand);
  bool search_is_due(const Hints& hints_px);
  Result<void> search(renderer::GreyView image);
  Result<void> look_for_either_side(renderer::GreyView image, const Region& region);
  void drop_double(const Hints& hints_px);
  void settle_sides(const Hints& hints_px);
  void remember(const Hints& hints_px, std::int64_t time_ns);

  static constexpr int kLongAgo = 1'000'000;

  std::unique_ptr<LandmarkModel> hand_;
  std::optional<PalmNetwork> palm_;
  int most_hands_;
  std::vector<Track> tracks_;
  std::vector<Candidate> candidates_;
  std::vector<FoundHand> found_;
  std::vector<float> left_scores_;  ///< beside found_
  int since_search_ = kLongAgo, since_side_ = 0;
  Times times_;
};

}  // namespace handcast::landmarks
