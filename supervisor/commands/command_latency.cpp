// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "supervisor/commands/choose_rig.hpp"
#include "supervisor/commands/verbs.hpp"
#include "supervisor/look/trace/history_request.hpp"
#include "supervisor/look/trace/latency_table.hpp"

namespace handcast::supervisor {

int run_latency(const Arguments& arguments) {
  auto line = command_line_of("latency");
  double seconds = 10;
  bool as_json = false;
  std::string name;
  line.add("--seconds N", seconds, "Of the last N seconds; supervisor.history_s are kept",
           kSomeSeconds);
  line.add("--json", as_json, "The same as JSON");
  add_rig(line, name);
  if (const auto code = line.answered(arguments)) return *code;

  const auto rig = choose_rig(name);
  if (!rig) return complain(rig.error());
  const auto history = ask_for_history(*rig, seconds);
  if (!history) return complain(history.error());
  const auto rates = ask_for_rates(*rig);
  if (!rates) return complain(rates.error());

  const auto table = measure_latency(*history, *rates);
  fmt::print("{}", as_json ? to_json(table).dump(2) + "\n" : print_latency(table));
  return kExitDone;
}

}  // namespace handcast::supervisor
