// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "ipc/base/write_whole.hpp"
#include "supervisor/commands/choose_rig.hpp"
#include "supervisor/commands/verbs.hpp"
#include "supervisor/look/trace/history_request.hpp"
#include "supervisor/look/trace/perfetto.hpp"

namespace handcast::supervisor {

int run_trace(const Arguments& arguments) {
  auto line = command_line_of("trace");
  double seconds = 10;
  std::string path, name;
  line.add("--seconds N", seconds, "The last N seconds; supervisor.history_s are kept",
           kSomeSeconds);
  line.add("-o, --out FILE", path, "The file to write; ui.perfetto.dev opens it");
  add_rig(line, name);
  if (const auto code = line.answered(arguments)) return *code;
  if (path.empty()) return line.refuse("-o FILE is needed");
  if (const auto good = check_result_file(path); !good) return complain(good.error());

  const auto rig = choose_rig(name);
  if (!rig) return complain(rig.error());
  const auto history = ask_for_history(*rig, seconds);
  if (!history) return complain(history.error());

  const auto trace = perfetto_trace(*history, *rig, ClockReadings::now());
  if (const auto written = write_whole(path, trace); !written) return complain(written.error());
  fmt::print("{}: {} frames of {} services, {:.1f} MB; open it in https://ui.perfetto.dev\n", path,
             history->frames.size(), history->services.size(),
             static_cast<double>(trace.size()) * 1e-6);
  return kExitDone;
}

}  // namespace handcast::supervisor
