// SPDX-License-Identifier: Apache-2.0
// handcast devices: what is attached, and what it would be called in a rig file.
#include <fmt/format.h>

#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/verb_options.hpp"
#include "services/devices/attached.hpp"

static int run_verb(int argc, char** argv) {
  using namespace handcast;
  CLI::App app(
      "Lists the cameras, displays and projector controllers of this computer, with the settings "
      "that use them, and why one cannot be opened.",
      "handcast devices");
  bool as_json = false;
  app.add_flag("--json", as_json, "The same as JSON");
  const auto text = parse_options(app, argc, argv);
  if (!text) {
    fmt::print(stderr, "handcast devices: {}\n", text.error().what);
    return kExitUsage;
  }
  if (!text->empty()) {
    fmt::print("{}", *text);
    return kExitDone;
  }
  const auto attached = devices::all_attached();
  fmt::print("{}", as_json ? devices::to_json(attached)
                           : printable(devices::print(attached, devices::blind_spots())));
  return kExitDone;
}

int main(int argc, char** argv) {
  return handcast::run_program("handcast devices", argc, argv, run_verb);
}
