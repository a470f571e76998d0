// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "supervisor/base/options.hpp"
#include "supervisor/commands/choose_rig.hpp"
#include "supervisor/commands/verbs.hpp"
#include "supervisor/look/trace/history_request.hpp"
#include "supervisor/look/trace/latency_table.hpp"

namespace handcast::supervisor {

int run_latency(const Arguments& arguments) {
  const auto options =
      sort_options(arguments, {.with_value = {"--seconds", "--rig"}, .flags = {"--json"}});
  if (!options)
    return complain(kExitUsage, "latency: " + options.error().what + "; `handcast help latency`");
  const auto seconds =
      parse_seconds(options->has("--seconds") ? options->value("--seconds") : "10");
  if (!seconds) return complain(kExitUsage, "latency: " + seconds.error().what);

  const auto rig = choose_rig(options->value("--rig"));
  if (!rig) return complain(rig.error());
  const auto history = ask_for_history(*rig, *seconds);
  if (!history) return complain(history.error());
  const auto rates = ask_for_rates(*rig);
  if (!rates) return complain(rates.error());

  const auto table = measure_latency(*history, *rates);
  fmt::print("{}", options->has("--json") ? to_json(table).dump(2) + "\n" : print_latency(table));
  return kExitDone;
}

}  // namespace handcast::supervisor
