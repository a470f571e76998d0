// SPDX-License-Identifier: Apache-2.0
#include "services/pose/watch/complaints.hpp"

#include <fmt/format.h>

#include <string_view>

namespace handcast::pose {
namespace {

/// Faults are frequent if so many began in kWithin_ns, and have ended after kEnded_ns without one.
constexpr std::int64_t kWithin_ns = 2'000'000'000, kEnded_ns = 10'000'000'000;

struct Words {
  std::size_t frequent;       ///< so many are said
  std::string_view sentence;  ///< what happens
};
constexpr std::array<Words, msg::kTrackerFaults> kWords{{
    {1, "repeats a pose: it has frozen"},
    {3, "jumps: its hands move as no hand can"},
    {3, "flickers: hands are gone for moments"},
    {1, "exchanges the left and the right hand"},
    {10, "is late: samples are much older than usual when they arrive, or their stamps are wrong"},
    {1, "reports poses that no hand can have; they are left out"},
}};

}  // namespace

std::vector<std::string> Complaints::add(std::int64_t time_ns, const msg::TrackerFaults& faults) {
  std::vector<std::string> sentences;
  for (std::size_t i = 0; i < kinds_.size(); ++i) {
    Kind& kind = kinds_[i];
    const Words& words = kWords[i];
    kind.since_said += faults.count[i];
    for (std::uint32_t n = 0; n < faults.count[i]; ++n) kind.recent_ns.push_back(time_ns);
    while (kind.recent_ns.size() > words.frequent) kind.recent_ns.pop_front();
    const std::int64_t newest_ns = kind.recent_ns.empty() ? 0 : kind.recent_ns.back();
    if (!kind.is_said && kind.recent_ns.size() == words.frequent &&
        time_ns - kind.recent_ns.front() < kWithin_ns) {
      kind.is_said = true;
      kind.since_said = 0;
      sentences.push_back(fmt::format("{} {}", source_, words.sentence));
    } else if (kind.is_said && time_ns - newest_ns > kEnded_ns) {
      kind.is_said = false;
      kind.recent_ns.clear();
      sentences.push_back(fmt::format("{}: '{}' has ended; it happened {} more times", source_,
                                      msg::kTrackerFaultNames[i], kind.since_said));
    }
  }
  return sentences;
}

}  // namespace handcast::pose
