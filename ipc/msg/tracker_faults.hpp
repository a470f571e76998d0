// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace handcast::msg {

/// What a hand tracker can do wrong and its samples show.
enum class TrackerFault : std::uint32_t {
  frozen,      ///< it repeats a pose
  jumped,      ///< a hand moves as none can
  flickered,   ///< a hand is gone for a moment
  exchanged,   ///< a left hand is reported as a right one, or vice versa
  late,        ///< a sample is much older than usual when it arrives, or its stamp is wrong
  impossible,  ///< a pose is not finite, or no hand has it
  count        ///< number of kinds
};

inline constexpr auto kTrackerFaults = static_cast<std::size_t>(TrackerFault::count);

/// The names of the kinds in reports, in the order of TrackerFault.
inline constexpr std::array<std::string_view, kTrackerFaults> kTrackerFaultNames{
    "frozen", "jumped", "flickered", "exchanged", "late", "impossible"};

/// How often each kind of fault began.
struct TrackerFaults {
  std::array<std::uint32_t, kTrackerFaults> count{};  ///< by TrackerFault

  /// The count of one kind.
  /// @{
  std::uint32_t& of(TrackerFault fault) { return count[static_cast<std::size_t>(fault)]; }
  std::uint32_t of(TrackerFault fault) const { return count[static_cast<std::size_t>(fault)]; }
  /// @}
  /// Adds the counts of another stretch of time.
  TrackerFaults& operator+=(const TrackerFaults& more) {
    for (std::size_t i = 0; i < count.size(); ++i) count[i] += more.count[i];
    return *this;
  }
  bool operator==(const TrackerFaults&) const = default;
};

/// The counts as a number, StageMark::detail of Stage::sample: 5 bits each, at most 31.
inline constexpr std::uint32_t detail_of(const TrackerFaults& faults) {
  std::uint32_t detail = 0;
  for (std::size_t i = 0; i < kTrackerFaults; ++i)
    detail |= std::min<std::uint32_t>(faults.count[i], 31) << (5 * i);
  return detail;
}
/// The counts in a number.
inline constexpr TrackerFaults tracker_faults_in(std::uint32_t detail) {
  TrackerFaults faults;
  for (std::size_t i = 0; i < kTrackerFaults; ++i) faults.count[i] = detail >> (5 * i) & 31;
  return faults;
}

}  // namespace handcast::msg
