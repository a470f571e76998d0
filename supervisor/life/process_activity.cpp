// SPDX-License-Identifier: Apache-2.0
#include "supervisor/life/process_activity.hpp"

#include <fmt/format.h>

#include <algorithm>
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

/// Adds the three counters of schedstat: ns on a processor, ns of waiting, number of slices.
void add_progress(const std::filesystem::path& thread, ProcessLook& look) {
  std::ifstream file(thread / "schedstat");
  std::uint64_t worked_ns = 0, waited_ns = 0, slices = 0;
  if (!(file >> worked_ns >> waited_ns >> slices)) return;
  look.progress += worked_ns + waited_ns + slices;
  look.worked_ns += static_cast<std::int64_t>(worked_ns);
  look.waited_ns += static_cast<std::int64_t>(waited_ns);
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
    look.on_disk = look.on_disk || state == 'D';
    add_progress(thread->path(), look);
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

std::int64_t held_up_ns(const std::optional<ProcessLook>& before,
                        const std::optional<ProcessLook>& now, std::int64_t between_ns) {
  if (activity_between(before, now) != Activity::busy) return 0;
  const auto idle_ns = between_ns - (now->worked_ns - before->worked_ns);
  const auto waited_ns = now->waited_ns - before->waited_ns;
  return std::clamp<std::int64_t>(now->on_disk ? idle_ns : waited_ns, 0,
                                  std::max<std::int64_t>(idle_ns, 0));
}

}  // namespace handcast::supervisor
