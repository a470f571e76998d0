// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "ipc/base/exit_code.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/version.hpp"
#include "services/lab/simulate/run.hpp"

static int run_verb(int argc, char** argv) {
  using namespace handcast;
  const auto options = simulate::parse_options(argc, argv);
  if (!options) {
    fmt::print(stderr, "handcast simulate: {}\n", options.error().what);
    return kExitUsage;
  }
  if (options->help) {
    fmt::print("{}", simulate::help());
    return kExitDone;
  }
  if (options->version) {
    fmt::print("handcast simulate {}\n", version());
    return kExitDone;
  }
  const auto fault = simulate::run(*options);
  if (!fault) {
    fmt::print(stderr, "handcast simulate: {}\n", fault.error().what);
    return exit_code_of(fault.error());
  }
  if (fault->empty()) return kExitDone;
  fmt::print(stderr, "handcast simulate: {}\n", *fault);
  return kExitBadResult;
}

int main(int argc, char** argv) {
  return handcast::run_program("handcast simulate", argc, argv, run_verb);
}
