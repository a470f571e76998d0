// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/program.hpp"
#include "services/lab/simulate/run.hpp"

int main(int argc, char** argv) {
  using namespace handcast;
  return run_program("handcast simulate", argc, argv, [](int count, char** words) {
    return simulate::run_verb("handcast simulate", simulate::parse(count, words));
  });
}
