// SPDX-License-Identifier: Apache-2.0
#include "services/watch/fault_book.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "ipc/base/clock.hpp"

namespace handcast::watch {
namespace {

std::string moment(std::time_t time) { return date_of(time) + " " + clock_of(time); }

}  // namespace

bool FaultBook::may_tell(const std::string& kind, std::time_t time) const {
  const auto last = day_.alerted.find(kind);
  // A clock that was set back does not silence the alerts.
  return last == day_.alerted.end() ||
         static_cast<double>(std::llabs(time - last->second)) >= settings_.again_s;
}

bool FaultBook::has_open() const {
  return std::ranges::any_of(day_.faults, [](const Fault& fault) { return fault.until.empty(); });
}

double FaultBook::lasting_s(std::int64_t now_ns) const {
  double longest_s = 0;
  for (const auto& [kind, seen] : seen_)
    if (kind != "disk") longest_s = std::max(longest_s, ns_to_seconds(now_ns - seen.first_ns));
  return longest_s;
}

std::vector<FaultBook::Notice> FaultBook::look(const Wrongs& wrongs, std::int64_t now_ns,
                                               std::time_t time) {
  std::vector<Notice> notices;
  for (const auto& [kind, sentence] : wrongs) {
    seen_.try_emplace(kind, Seen{now_ns, now_ns}).first->second.last_ns = now_ns;
    auto* fault = day_.open_fault(kind);
    if (!fault && day_.faults.size() < Day::kMostFaults)
      fault = &day_.faults.emplace_back(
          Fault{.kind = kind, .sentence = sentence, .since = moment(time)});
    if (!fault || fault->told || !may_tell(kind, time)) continue;
    fault->told = true;
    day_.alerted[kind] = time;
    notices.push_back({kind, fmt::format("{} (since {})", sentence, fault->since)});
  }
  for (auto& fault : day_.faults) {
    if (!fault.until.empty() || wrongs.contains(fault.kind)) continue;
    const auto seen = seen_.try_emplace(fault.kind, Seen{now_ns, now_ns}).first;
    if (ns_to_seconds(now_ns - seen->second.last_ns) < settings_.well_s) continue;
    fault.until = moment(time);
    seen_.erase(seen);
    if (fault.told)
      notices.push_back(
          {fault.kind,
           fmt::format("it is over: {} ({} to {})", fault.sentence, fault.since, fault.until),
           true});
  }
  return notices;
}

}  // namespace handcast::watch
