// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"
#include "renderer/mask/run_map.hpp"
#include "services/landmarks/crop/box_filter.hpp"
#include "services/landmarks/finder/found_hand.hpp"
#include "services/landmarks/finder/steady_hints.hpp"
#include "services/landmarks/geometry/points.hpp"
#include "services/landmarks/geometry/region.hpp"
#include "services/landmarks/models/landmark_models.hpp"

namespace handcast::landmarks {

/// A bright part of an image that may be a hand with its arm: regions for a landmark model, one
/// for each direction in which the fingers may point, the most likely one first.
struct BrightHand {
  static constexpr int kDirections = 8;     ///< 45 degrees apart
  std::array<Region, kDirections> regions;  ///< around the widest place of the part
};

/// Searches infrared images for hands without a network: the largest bright parts. The palm is
/// taken to be around the centre of the largest circle in the part; the fingers, to point away from
/// where the part meets the edge of the image (the arm), otherwise along the part. One thread.
class BrightHands {
 public:
  /// At most two, the larger first. Parts on which one of `known` (the points of a hand, image px)
  /// lies are left out. The threshold between dark and bright is that of the mask
  /// (choose_threshold()); an image without two classes has no bright part. `places`: of a part,
  /// the widest first, because a sleeve may be wider than the palm. Valid until the next call.
  std::span<const BrightHand> search(renderer::GreyView image, std::span<const Points> known,
                                     int places = 1);

 private:
  struct Part {
    std::vector<glm::ivec2> pixels;
    glm::vec2 at_edge{0};  ///< mean of the pixels at the edge of the image
    int edge_pixels = 0;
  };
  /// The largest circle in a part.
  struct Circle {
    glm::vec2 centre;
    float radius;
  };

  std::vector<int> largest_parts(std::span<const Points> known);
  Part read(int root);
  std::vector<Circle> widest_places(const Part& part, int most);
  BrightHand around(const Part& part, const Circle& palm) const;

  BoxFilter smaller_;
  renderer::Image<std::uint8_t> bright_;   ///< of the shrunken image: 0 or 255
  renderer::Image<std::uint16_t> inside_;  ///< distance to the dark, in thirds of a pixel
  renderer::RunMap runs_;
  std::vector<BrightHand> found_;
};

/// The least mean confidence of a hand whose own points are followed in the next image. With less,
/// the points may lie beside the hand.
inline constexpr float kSteadyConfidence = 0.6f;

/// A place in the next image where a hand may be.
struct HandCandidate {
  msg::Side side;                 ///< which hand it may be
  Region region;                  ///< the part of the image to examine
  std::optional<Points> hint_px;  ///< the tracker's joints of this hand
  bool is_followed = false;       ///< the last image had the hand with kSteadyConfidence
  float left_score = -1;          ///< FoundHand::left_score in the last image; negative: not known
  std::optional<Points> before_px{};  ///< its points in the last image that had it
  float comparisons = 0;              ///< FoundHand::comparisons
};

/// The place of a hand in an array by side.
inline std::size_t index_of(msg::Side side) { return static_cast<std::size_t>(side); }
/// True if the tracker has the hand, at finite coordinates.
bool is_usable(const std::optional<Points>& hint_px);
/// True if both sets of points lie on the same hand.
bool are_one_hand(const Points& a, const Points& b);

/// The hands of the last images, and where they may be in the next one. One thread, no allocation
/// while hands are followed.
class HandTracks {
 public:
  /// The candidates, in this order: hands that were found where the tracker has them; other hands
  /// of the tracker; hands that only the last image has. Valid until the next call.
  std::span<HandCandidate> candidates(const Hints& hints_px, const LandmarkModel& model);

  /// Stores the hands found in the image of `time_ns`. A hand that was not found is kept, because
  /// the next image may show it.
  void remember(std::span<const FoundHand> found, const Hints& hints_px, const LandmarkModel& model,
                std::int64_t time_ns);

  /// Drops the hands that were found too long before `time_ns` to be followed.
  void drop_old(std::int64_t time_ns);
  /// Drops all hands.
  void clear() { tracks_.clear(); }

 private:
  struct Track {
    msg::Side side;
    Points points_px;
    Points around_px;  ///< points_px, with those of little confidence replaced by the tracker's
    std::optional<Points> hint_px;  ///< the tracker's joints at that time
    float left_score;
    std::int64_t found_ns;
    float comparisons;
    bool steady;  ///< found in the last image with kSteadyConfidence
  };

  std::optional<std::size_t> track_of(msg::Side side, const Points& hint_px,
                                      const LandmarkModel& model) const;
  HandCandidate followed(const Track& track, msg::Side side, const Points& hint_px,
                         const LandmarkModel& model) const;

  std::vector<Track> tracks_;
  std::vector<HandCandidate> candidates_;
};

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

  /// `most_hands`: 1 or 2. `places`: of each bright part that are searched; each takes up to 16
  /// runs of the model.
  HandFinder(OpenedModel model, int most_hands, Poses poses = Poses::of_a_tracker, int places = 1)
      : model_(std::move(model)),
        most_hands_(most_hands),
        lifts_(poses == Poses::of_landmarks),
        places_(places) {}

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
  float least_share_of_comparison(const FoundHand& hand);
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
  int places_;  ///< of a bright part
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
