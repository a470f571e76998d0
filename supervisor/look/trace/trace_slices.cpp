// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/trace/trace_slices.hpp"

#include <algorithm>
#include <tuple>

namespace handcast::supervisor {
namespace {

/// A lane that is being filled.
struct OpenLane {
  Lane slices;
  std::vector<Slice> open;  ///< the slices that are open at its end, innermost last

  bool take(const Slice& slice) {
    while (!open.empty() && open.back().mark.end_ns <= slice.mark.begin_ns) open.pop_back();
    const bool fits = open.empty() || (open.back().frame == slice.frame &&
                                       open.back().mark.end_ns >= slice.mark.end_ns);
    if (!fits) return false;
    slices.push_back(slice);
    open.push_back(slice);
    return true;
  }
};

std::vector<Lane> arrange(std::vector<Slice> slices) {
  std::ranges::stable_sort(slices, {}, [](const Slice& slice) {
    return std::tuple(slice.mark.begin_ns, -slice.mark.end_ns);
  });
  std::vector<OpenLane> lanes(1);
  for (const auto& slice : slices)
    if (std::ranges::none_of(lanes, [&](OpenLane& lane) { return lane.take(slice); }))
      lanes.emplace_back().take(slice);

  std::vector<Lane> arranged;
  for (auto& lane : lanes) arranged.push_back(std::move(lane.slices));
  return arranged;
}

}  // namespace

std::vector<std::vector<Lane>> lanes_of(const HistorySnapshot& history) {
  std::vector<std::vector<Slice>> work(history.services.size()), light(history.services.size());
  for (std::size_t i = 0; i < history.frames.size(); ++i)
    for (const auto& mark : history.frames[i].marks)
      (mark.stage == msg::Stage::light ? light : work)[history.frames[i].service].push_back(
          {i, mark});

  std::vector<std::vector<Lane>> lanes;
  for (std::size_t service = 0; service < work.size(); ++service) {
    lanes.push_back(arrange(std::move(work[service])));
    // Light has lanes of its own below: it overlaps with the work on the next frame.
    for (auto& lane : arrange(std::move(light[service]))) lanes.back().push_back(std::move(lane));
  }
  return lanes;
}

}  // namespace handcast::supervisor
