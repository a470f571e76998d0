// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "services/landmarks/finder/found_hand.hpp"
#include "services/landmarks/tracker/tracker_hints.hpp"

namespace handcast::landmarks {

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
  int comparisons = 0;                ///< FoundHand::comparisons
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
    int comparisons;
    bool steady;  ///< found in the last image with kSteadyConfidence
  };

  std::optional<std::size_t> track_of(msg::Side side, const Points& hint_px,
                                      const LandmarkModel& model) const;
  HandCandidate followed(const Track& track, msg::Side side, const Points& hint_px,
                         const LandmarkModel& model) const;

  std::vector<Track> tracks_;
  std::vector<HandCandidate> candidates_;
};

}  // namespace handcast::landmarks
