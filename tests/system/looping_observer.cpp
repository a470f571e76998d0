// SPDX-License-Identifier: Apache-2.0
// An observer that enters an endless loop, once, when the file named by HANDCAST_LOOP exists.
#include <cstdlib>
#include <filesystem>

#include "services/runtime/context.hpp"

int main(int argc, char** argv) {
  using namespace handcast;
  return service::run({.name = "observer", .summary = "Loops when it is told to."}, argc, argv,
                      [](service::Context& context) {
                        const char* file = std::getenv("HANDCAST_LOOP");
                        context.ready();
                        while (context.running()) {
                          sleep_until_ns(now_ns() + 20'000'000);
                          if (!file || !std::filesystem::remove(file)) continue;
                          for (volatile bool for_ever = true; for_ever;) {
                          }
                        }
                      });
}
