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

inline constexpr std::int64_t kLoneStep_ns =
    10'000'000;  ///< from the only item of a sensor to the end of its lap

/// The time a recording takes, one for all its sensors: from the earliest item until the last
/// sensor is through.
struct Lap {
  std::int64_t first_ns = 0, length_ns = 0;

  static Lap of(const std::vector<std::vector<std::int64_t>>& sensors_ns) {
    Lap lap;
    for (const auto& times_ns : sensors_ns) lap.add(times_ns, kLoneStep_ns);
    return lap;
  }

  /// A sensor is through a mean step after its last item (`lone_step_ns` where it has only one).
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

/// When the items of a sensor are due if its recording is played from `start_ns` on, over and over.
/// A pure function of time: every daemon that starts at the rig's epoch is at the same place of the
/// recording, also after a restart.
class Loop {
 public:
  struct Item {
    std::size_t index = 0;     ///< into the recording
    std::uint64_t number = 0;  ///< counts on from lap to lap
    std::int64_t due_ns = 0;
  };

  /// `times_ns` are of the clock of `lap`, which is made longer where they do not lie within it.
  /// Errors (bad_config): no item, times that do not increase.
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

  /// The first item due at `time_ns` or later; nothing where the recording is over.
  std::optional<Item> at_or_after(std::int64_t time_ns) const {
    const std::int64_t played_ns = std::max<std::int64_t>(time_ns - start_ns_, 0);
    const auto found = std::lower_bound(times_ns_.begin(), times_ns_.end(), played_ns % lap_ns_);
    return item(played_ns / lap_ns_ * count() + (found - times_ns_.begin()));
  }

  /// The item due nearest to `time_ns`.
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
