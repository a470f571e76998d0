// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/diary.hpp"

namespace handcast::supervisor {

std::vector<Diary::Entry> Diary::look(std::int64_t now_ns, const Figures& figures,
                                      const std::string& summary) {
  std::vector<Entry> entries;
  if (now_ns >= next_summary_ns_) {
    entries.push_back({log::Level::info, summary});
    next_summary_ns_ = now_ns + kSummary_ns;
  }
  tell_changes(now_ns, figures, entries);
  return entries;
}

void Diary::tell_changes(std::int64_t now_ns, const Figures& figures, std::vector<Entry>& entries) {
  for (const auto& [name, stream] : figures.streams) {
    auto& pace = paces_[name];
    if (!stream.is_settled || stream.slow() == pace.told_slow) {
      pace.since_ns = 0;
      continue;
    }
    if (pace.since_ns == 0) pace.since_ns = now_ns;
    if (now_ns - pace.since_ns < kWhile_ns) continue;
    pace = {.told_slow = stream.slow()};
    if (pace.told_slow)
      entries.push_back(
          {log::Level::warning,
           fmt::format("{} is slow: {:.0f} Hz of {:.0f} Hz; `handcast latency` shows where the "
                       "time goes",
                       name, stream.held_hz, stream.wanted_hz.value_or(0))});
    else
      entries.push_back({log::Level::info,
                         fmt::format("{} holds its rate again: {:.0f} Hz", name, stream.held_hz)});
  }
}

}  // namespace handcast::supervisor
