// SPDX-License-Identifier: Apache-2.0
#include "supervisor/life/process_activity.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "supervisor/base/process.hpp"

namespace handcast::supervisor {
namespace {

/// The state of a thread; 0 if there is no such thread.
char state_in(const std::filesystem::path& thread) {
  constexpr int kStateField = 3;
  const auto state = stat_field(thread, kStateField);
  return state.empty() ? '\0' : state.front();
}

/// The sum of the three counters of schedstat: ns on a processor, ns of waiting, number of slices.
std::uint64_t progress_in(const std::filesystem::path& thread) {
  std::ifstream file(thread / "schedstat");
  std::uint64_t sum = 0, counter = 0;
  while (file >> counter) sum += counter;
  return sum;
}

}  // namespace

std::optional<ProcessLook> look_at_process(pid_t pid) {
  ProcessLook look{.all_stopped = true, .all_asleep = true};
  std::error_code error;
  const std::filesystem::directory_iterator threads(fmt::format("/proc/{}/task", pid), error);
  for (auto thread = threads; !error && thread != std::filesystem::directory_iterator();
       thread.increment(error)) {
    const char state = state_in(thread->path());
    if (state == '\0') continue;  // it ended meanwhile
    ++look.threads;
    look.all_stopped = look.all_stopped && (state == 'T' || state == 't');
    look.all_asleep = look.all_asleep && state == 'S';
    look.progress += progress_in(thread->path());
  }
  if (error || look.threads == 0) return std::nullopt;
  return look;
}

Activity activity_between(const std::optional<ProcessLook>& before,
                          const std::optional<ProcessLook>& now) {
  if (!before || !now) return Activity::unknown;
  if (before->all_stopped && now->all_stopped) return Activity::stopped;
  if (now->progress == 0) return Activity::unknown;
  const bool idle = before->threads == now->threads && before->progress == now->progress;
  return idle && before->all_asleep && now->all_asleep ? Activity::asleep : Activity::busy;
}

}  // namespace handcast::supervisor
