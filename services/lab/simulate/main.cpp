// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "ipc/base/command_line.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "services/lab/simulate/run.hpp"

static int run_verb(int argc, char** argv) {
  using namespace handcast;
  const auto options = simulate::parse(argc, argv);
  const auto text = options.map([](const auto& each) { return each.text; });
  if (const auto code = answered("handcast simulate", text)) return *code;
  const auto fault = simulate::run(*options);
  if (!fault) {
    fmt::print(stderr, "handcast simulate: {}\n", printable(fault.error().what));
    return exit_code_of(fault.error());
  }
  if (fault->empty()) return kExitDone;
  fmt::print(stderr, "handcast simulate: {}\n", printable(*fault));
  return kExitBadResult;
}

int main(int argc, char** argv) {
  return handcast::run_program("handcast simulate", argc, argv, run_verb);
}
