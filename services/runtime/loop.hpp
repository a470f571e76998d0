// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::timing {

/// The duration of the only item of a sensor.
inline constexpr std::int64_t kLoneStep_ns = 10'000'000;

/// One pass through a recording, common to all its sensors: from the earliest item to the end of
/// the last one.
struct Lap {
  std::int64_t first_ns = 0;   ///< time of the earliest item, on the clock of the recording
  std::int64_t length_ns = 0;  ///< duration; 0: no item has been added

  /// The lap of these sensors, each given by the times of its items.
  static Lap of(const std::vector<std::vector<std::int64_t>>& sensors_ns) {
    Lap lap;
    for (const auto& times_ns : sensors_ns) lap.add(times_ns, kLoneStep_ns);
    return lap;
  }

  /// Extends the lap by the items of a sensor. Its last item lasts for a mean step, or for
  /// `lone_step_ns` if it is the only one.
  void add(const std::vector<std::int64_t>& times_ns, std::int64_t lone_step_ns) {
    if (times_ns.empty()) return;
    const auto steps = static_cast<std::int64_t>(times_ns.size()) - 1;
    const std::int64_t step_ns =
        steps > 0 ? (times_ns.back() - times_ns.front()) / steps : lone_step_ns;
    std::int64_t end_ns = times_ns.back() + std::max<std::int64_t>(step_ns, 1);
    if (length_ns > 0) end_ns = std::max(end_ns, first_ns + length_ns);
    first_ns = length_ns > 0 ? std::min(first_ns, times_ns.front()) : times_ns.front();
    length_ns = end_ns - first_ns;
  }
};

/// The schedule of a sensor whose recording is played repeatedly from `start_ns` on. It is a pure
/// function of time, so all daemons of a rig are at the same place of the recording, also after a
/// restart.
class Loop {
 public:
  /// An item of the schedule.
  struct Item {
    std::size_t index = 0;     ///< index into the recording
    std::uint64_t number = 0;  ///< number of the item, counted over all laps
    std::int64_t due_ns = 0;   ///< when to play it, on the clock of `start_ns`
  };

  /// `times_ns`: the times of the items on the clock of `lap`, which is extended by them. `repeat`:
  /// false: the schedule ends after one lap. `lone_step_ns`: see Lap::add(). Errors (bad_config):
  /// there is no item; the times do not increase.
  static Result<Loop> make(std::vector<std::int64_t> times_ns, Lap lap, std::int64_t start_ns,
                           bool repeat, std::int64_t lone_step_ns) {
    if (times_ns.empty()) return fail(Errc::bad_config, "the recording is empty");
    if (std::adjacent_find(times_ns.begin(), times_ns.end(), std::greater_equal<>{}) !=
        times_ns.end())
      return fail(Errc::bad_config, "the times of the recording do not increase");
    lap.add(times_ns, lone_step_ns);
    for (auto& time_ns : times_ns) time_ns -= lap.first_ns;
    return Loop(std::move(times_ns), start_ns, lap.length_ns, repeat);
  }

  /// The first item due at `time_ns` or later; empty if the recording has ended.
  std::optional<Item> at_or_after(std::int64_t time_ns) const {
    const std::int64_t played_ns = std::max<std::int64_t>(time_ns - start_ns_, 0);
    const auto found = std::lower_bound(times_ns_.begin(), times_ns_.end(), played_ns % lap_ns_);
    return item(played_ns / lap_ns_ * count() + (found - times_ns_.begin()));
  }

  /// The item whose due time is nearest to `time_ns`; empty if the recording has ended.
  std::optional<Item> nearest(std::int64_t time_ns) const {
    const auto after = at_or_after(time_ns);
    if (!after || after->number == 0) return after;
    const auto before = item(static_cast<std::int64_t>(after->number) - 1);
    return time_ns - before->due_ns < after->due_ns - time_ns ? before : after;
  }

 private:
  Loop(std::vector<std::int64_t> times_ns, std::int64_t start_ns, std::int64_t lap_ns, bool repeat)
      : times_ns_(std::move(times_ns)), start_ns_(start_ns), lap_ns_(lap_ns), repeat_(repeat) {}

  std::int64_t count() const { return static_cast<std::int64_t>(times_ns_.size()); }
  std::optional<Item> item(std::int64_t number) const {
    if (!repeat_ && number >= count()) return std::nullopt;
    const auto index = static_cast<std::size_t>(number % count());
    return Item{index, static_cast<std::uint64_t>(number),
                start_ns_ + number / count() * lap_ns_ + times_ns_[index]};
  }

  std::vector<std::int64_t> times_ns_;
  std::int64_t start_ns_ = 0, lap_ns_ = 1;
  bool repeat_ = true;
};

}  // namespace handcast::timing
