// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "renderer/base/recent.hpp"
#include "renderer/filter/landmark_filter.hpp"

namespace handcast::renderer {

/// The landmarks that recent frames were drawn with, by target time; the last 150 ms. A filter
/// without hindsight takes P at the time of an image from here: as it was predicted for the frame
/// of that time, from the tracker samples that had arrived by then.
class TrackerMemory {
 public:
  /// Adds the landmarks of the frame for `target_ns`. Entries at or after that time are dropped.
  void remember(std::int64_t target_ns, const LandmarkPoints& tracker);
  /// The landmarks at `time_ns`, interpolated linearly. Empty outside the remembered times.
  std::optional<LandmarkPoints> at(std::int64_t time_ns) const;

 private:
  struct Entry {
    std::int64_t target_ns;
    LandmarkPoints tracker;
  };
  static constexpr std::size_t kMostEntries = 512;

  Recent<Entry> entries_{kMostEntries + 1};  ///< by target time
};

/// P at the time of a detection: as it was predicted then if `memory` is given (not nullptr) and
/// has it, else by hindsight from `tracker`. Empty if neither has it.
std::optional<LandmarkPoints> tracker_then(const TrackerAt& tracker, const TrackerMemory* memory,
                                           std::int64_t origin_ns);

}  // namespace handcast::renderer
