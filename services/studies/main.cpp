// SPDX-License-Identifier: Apache-2.0
// handcast study: studies and games with light on hands.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/quote.hpp"
#include "services/studies/character/course.hpp"
#include "services/studies/jnd/run.hpp"
#include "services/studies/pose/run.hpp"
#include "services/studies/shooter/run.hpp"

namespace handcast::study {
namespace {

struct Study {
  std::string_view name, sentence;
  int (*run)(int argc, char** argv);
};

constexpr std::array kStudies{
    Study{"jnd", "Which delay of light people notice, on a screen.", run_jnd},
    Study{"character", "How fast people read characters on their hand and act on them.",
          run_character},
    Study{"pose", "Poses to match, for play and for rehabilitation.", run_pose},
    Study{"shooter", "A game on the palm, steered by tilting it.", run_shooter},
};

int explain(std::FILE* out) {
  fmt::print(out, "usage: handcast study STUDY ...\n\nThe studies:\n");
  for (const auto& study : kStudies) fmt::print(out, "  {:<12} {}\n", study.name, study.sentence);
  fmt::print(out, "\nhandcast study STUDY --help explains one.\n");
  return out == stdout ? kExitDone : kExitUsage;
}

int run(int argc, char** argv) {
  const std::string_view name = argc > 1 ? argv[1] : "";
  if (name == "-h" || name == "--help") return explain(stdout);
  const auto study = std::ranges::find(kStudies, name, &Study::name);
  if (study != kStudies.end()) return study->run(argc - 1, argv + 1);
  if (name.empty()) return explain(stderr);
  fmt::print(stderr, "handcast study: there is no study {}; `handcast study --help` lists them\n",
             printable(quote(name)));
  return kExitUsage;
}

}  // namespace
}  // namespace handcast::study

int main(int argc, char** argv) {
  return handcast::run_program("handcast study", argc, argv, handcast::study::run);
}
