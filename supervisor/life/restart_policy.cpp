// SPDX-License-Identifier: Apache-2.0
#include "supervisor/life/restart_policy.hpp"

#include <algorithm>

namespace handcast::supervisor {
namespace {

std::int64_t wait_after(int earlier_deaths) {
  if (earlier_deaths == 0) return 0;
  auto wait_ns = kFirstWait_ns;
  for (int i = 1; i < earlier_deaths && wait_ns < kLongestWait_ns; ++i) wait_ns *= 2;
  return std::min(wait_ns, kLongestWait_ns);
}

std::int64_t with_jitter(std::int64_t wait_ns, double jitter) {
  return wait_ns + static_cast<std::int64_t>(kMostJitter * jitter * static_cast<double>(wait_ns));
}

bool was_healthy(const Death& death) {
  return death.ready_ns && death.died_ns - *death.ready_ns >= kHealthyAfter_ns;
}

}  // namespace

Decision decide(DeathRecord record, const Death& death, double jitter) {
  using What = Decision::Action;
  if (was_healthy(death)) record.streak = 0;
  std::erase_if(record.recent_ns, [&](std::int64_t earlier_ns) {
    return death.died_ns - earlier_ns >= kStormWindow_ns;
  });
  record.recent_ns.push_back(death.died_ns);

  Decision decision;
  decision.wait_ns = wait_after(record.streak++);
  if (death.exit.asks_for_a_person())
    decision.action = What::fail;
  else if (death.exit.is_success())
    decision.action = What::retire;
  else if (record.recent_ns.size() >= kStormDeaths) {
    decision.action = What::degrade;
    decision.wait_ns = kLongestWait_ns;
  }
  decision.wait_ns = with_jitter(decision.wait_ns, jitter);
  decision.record = std::move(record);
  return decision;
}

double jitter_at(std::int64_t now_ns) { return static_cast<double>(now_ns % 1009) / 1008; }

}  // namespace handcast::supervisor
