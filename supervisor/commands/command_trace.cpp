// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "ipc/base/write_whole.hpp"
#include "supervisor/base/options.hpp"
#include "supervisor/commands/choose_rig.hpp"
#include "supervisor/commands/verbs.hpp"
#include "supervisor/look/trace/history_request.hpp"
#include "supervisor/look/trace/perfetto.hpp"

namespace handcast::supervisor {

int run_trace(const Arguments& given) {
  auto arguments = given;
  std::ranges::replace(arguments, "-o", "--out");
  const auto options =
      sort_options(arguments, {.with_value = {"--seconds", "--out", "--rig"}, .flags = {}});
  if (!options)
    return complain(kExitUsage, "trace: " + options.error().what + "; `handcast help trace`");
  if (!options->has("--out"))
    return complain(kExitUsage, "trace: -o FILE is needed; `handcast help trace`");
  const auto seconds =
      parse_seconds(options->has("--seconds") ? options->value("--seconds") : "10");
  if (!seconds) return complain(kExitUsage, "trace: " + seconds.error().what);

  const auto rig = choose_rig(options->value("--rig"));
  if (!rig) return complain(rig.error());
  const auto history = ask_for_history(*rig, *seconds);
  if (!history) return complain(history.error());

  const auto path = options->value("--out");
  const auto trace = perfetto_trace(*history, *rig, ClockReadings::now());
  if (const auto written = write_whole(path, trace); !written) return complain(written.error());
  fmt::print("{}: {} frames of {} services, {:.1f} MB; open it in https://ui.perfetto.dev\n", path,
             history->frames.size(), history->services.size(),
             static_cast<double>(trace.size()) * 1e-6);
  return kExitDone;
}

}  // namespace handcast::supervisor
