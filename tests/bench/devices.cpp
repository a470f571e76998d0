// SPDX-License-Identifier: Apache-2.0
// Drivers of devices, on emulated ones.
//   bench_devices [--goals FILE] [PART...]
#include "tests/bench/devices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#ifdef HANDCAST_WITH_HIDAPI
#include "tests/services/projector/dlp/emulated_hid.hpp"
#endif

namespace handcast::bench {
namespace {

struct Part {
  std::string_view name;
  void (*measure)(std::vector<Goal>&);
};

constexpr std::array kParts{
#ifdef HANDCAST_WITH_HIDAPI
    Part{"hid", measure_hid},
#endif
};

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  using namespace handcast::bench;
#ifdef HANDCAST_WITH_HIDAPI
  handcast::test::see_emulated_devices(argv);
#endif
  std::vector<std::string_view> words(argv + 1, argv + argc);
  std::string goals_file;
  if (const auto option = std::ranges::find(words, "--goals");
      option != words.end() && option + 1 != words.end()) {
    goals_file = *(option + 1);
    words.erase(option, option + 2);
  }
  std::vector<Goal> goals;
  for (const auto& part : kParts)
    if (words.empty() || std::ranges::find(words, part.name) != words.end()) part.measure(goals);
  print_goals(goals);
  if (goals_file.empty() || write_goals(goals_file, goals)) return 0;
  fmt::print(stderr, "bench_devices: cannot write '{}'.\n", goals_file);
  return 1;
}
