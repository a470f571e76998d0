// SPDX-License-Identifier: Apache-2.0
#include "renderer/filter/tracker_memory.hpp"

#include <algorithm>

namespace handcast::renderer {
namespace {

constexpr std::int64_t kKept_ns = 150'000'000;

}  // namespace

void TrackerMemory::remember(std::int64_t target_ns, const LandmarkPoints& tracker) {
  while (!entries_.empty() && entries_.back().target_ns >= target_ns) entries_.pop_back();
  entries_.push_back({target_ns, tracker});
  while (entries_.size() > kMostEntries || entries_.front().target_ns < target_ns - kKept_ns)
    entries_.pop_front();
}

std::optional<LandmarkPoints> TrackerMemory::at(std::int64_t time_ns) const {
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

std::optional<LandmarkPoints> tracker_then(const TrackerAt& tracker, const TrackerMemory* memory,
                                           std::int64_t origin_ns) {
  if (memory)
    if (const auto then = memory->at(origin_ns)) return then;
  return tracker(origin_ns);
}

}  // namespace handcast::renderer
