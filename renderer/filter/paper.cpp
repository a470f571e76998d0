// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "renderer/base/recent.hpp"
#include "renderer/filter/filters.hpp"

namespace handcast::renderer {
namespace {

/// The P that recent frames were drawn with, by target time; the last 150 ms.
class DrawnTracker {
 public:
  /// Adds P of the frame for `target_ns`. Entries at or after that time are dropped.
  void remember(std::int64_t target_ns, const LandmarkPoints& tracker) {
    while (!entries_.empty() && entries_.back().target_ns >= target_ns) entries_.pop_back();
    entries_.push_back({target_ns, tracker});
    while (entries_.size() > kMostEntries || entries_.front().target_ns < target_ns - kKept_ns)
      entries_.pop_front();
  }

  /// P at `time_ns`, interpolated linearly. Empty outside the remembered times.
  std::optional<LandmarkPoints> at(std::int64_t time_ns) const {
    const auto after = std::lower_bound(
        entries_.begin(), entries_.end(), time_ns,
        [](const Entry& entry, std::int64_t wanted_ns) { return entry.target_ns < wanted_ns; });
    if (after == entries_.end()) return std::nullopt;
    if (after->target_ns == time_ns) return after->tracker;
    if (after == entries_.begin()) return std::nullopt;
    const auto before = std::prev(after);
    const auto t = static_cast<float>(static_cast<double>(time_ns - before->target_ns) /
                                      static_cast<double>(after->target_ns - before->target_ns));
    LandmarkPoints points;
    for (int i = 0; i < kLandmarks; ++i)
      points[i] = glm::mix(before->tracker[i], after->tracker[i], t);
    return points;
  }

 private:
  struct Entry {
    std::int64_t target_ns;
    LandmarkPoints tracker;
  };
  static constexpr std::size_t kMostEntries = 512;
  static constexpr std::int64_t kKept_ns = 150'000'000;

  Recent<Entry> entries_{kMostEntries + 1};
};

/// Q̂_T = Q_{T-t_L} + P_T - P_{T-t_L}, point by point (paper, "Moving Least Squares Deformation"). P
/// at the time of the image is the one that the frame of that time was drawn with: as it was
/// predicted from the samples that had arrived by then. A missing point keeps its last offset.
class PaperFilter final : public CarryFilter {
 public:
  void detection(std::int64_t, std::int64_t origin_ns, const msg::HandLandmarks& seen,
                 const TrackerAt& tracker) override {
    if (origin_ns < origin_ns_) return;
    auto then = drawn_.at(origin_ns);
    if (!then) then = tracker(origin_ns);
    if (!then) return;
    origin_ns_ = origin_ns;
    for (int i = 0; i < kLandmarks; ++i) {
      if (!was_seen(seen.points[i])) continue;
      offsets_[i] = position_px(seen.points[i]) - (*then)[i];
      known_[i] = true;
    }
  }

  std::optional<LandmarkPoints> at(std::int64_t, std::int64_t target_ns,
                                   const LandmarkPoints& tracker) override {
    drawn_.remember(target_ns, tracker);
    return moved_by(tracker, offsets_, known_);
  }

  void forget() override { known_ = {}; }

 private:
  DrawnTracker drawn_;
  std::array<glm::vec2, kLandmarks> offsets_{};
  std::array<bool, kLandmarks> known_{};
  std::int64_t origin_ns_ = 0;
};

}  // namespace

std::unique_ptr<CarryFilter> make_paper_filter() { return std::make_unique<PaperFilter>(); }

}  // namespace handcast::renderer
