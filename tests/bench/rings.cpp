// SPDX-License-Identifier: Apache-2.0
// What a ring costs between two processes, beside a Unix socket and ZeroMQ in the same, interleaved
// run.
//   bench_rings [--goals FILE] [--rounds N]
#include <fmt/format.h>

#include <cstdlib>
#include <string>
#include <string_view>

#include "ipc/shm/layout.hpp"
#include "tests/bench/rings_costs.hpp"
#include "tests/bench/rings_table.hpp"

namespace handcast::bench {
namespace {

struct Options {
  std::string goals_file;
  int rounds = 3;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; i += 2) {
    const std::string_view name = argv[i];
    if (i + 1 == argc) give_up(fmt::format("{} needs a value", name));
    if (name == "--goals")
      options.goals_file = argv[i + 1];
    else if (name == "--rounds")
      options.rounds = std::max(1, std::atoi(argv[i + 1]));
    else
      give_up(fmt::format("unknown option {}", name));
  }
  return options;
}

Goal measure_costs() {
  constexpr std::size_t kImage_bytes = 720 * 540;
  const double alone_ns = loan_and_publish_ns(0), beside_ns = loan_and_publish_ns(ipc::kReaderRows);
  fmt::print(
      "loan + publish: {:.0f} ns without a reader, {:.0f} ns with {}, {:.0f} ns where one of them "
      "reads without end\n",
      alone_ns, beside_ns, ipc::kReaderRows, loan_and_publish_ns(ipc::kReaderRows, true));
  fmt::print("take and give back {} B from the cache: leased {:.0f} ns, copied {:.0f} ns\n",
             kImage_bytes, take_ns(kImage_bytes, ipc::Hold::lease),
             take_ns(kImage_bytes, ipc::Hold::copy));
  return {fmt::format("loan + publish with {} readers", ipc::kReaderRows), beside_ns, 100, "ns"};
}

std::vector<Goal> measure_goals(int rounds) {
  const Goal cost = measure_costs();
  auto poses = table_of_poses(), images = table_of_images();
  for (int round = 0; round < rounds; ++round)
    for (auto* table : {&poses, &images})
      for (auto& row : table->rows) measure(row);
  print(poses);
  print(images);
  auto goals = goals_of(poses, images);
  goals.push_back(cost);
  return goals;
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  using namespace handcast::bench;
  const auto options = parse(argc, argv);
  const auto goals = measure_goals(options.rounds);
  if (!options.goals_file.empty() && !write_goals(options.goals_file, goals))
    give_up("cannot write " + options.goals_file);
}
