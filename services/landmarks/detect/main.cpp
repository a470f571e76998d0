// SPDX-License-Identifier: Apache-2.0
// handcast detect: the landmark detector on pictures.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "ipc/base/exit_code.hpp"
#include "ipc/base/version.hpp"
#include "services/landmarks/detect/run.hpp"

namespace handcast::detect {
namespace {

const char* const kFooter =
    R"(Each picture is looked at by itself, as the first image of a stream: where --joints says the hand is, else by the palm network.
Points are pixels of the picture from the centre of its upper left one, as the network defines them; the lens is left as it is.
Drawn with --out: bones and landmarks, the square the network was shown (its upper edge thick), the tracker's joints as crosses.)";

int detect(const Options& options) {
  const auto text = run(options);
  if (!text) {
    fmt::print(stderr, "handcast detect: {}\n", text.error().what);
    return exit_code_of(text.error());
  }
  fmt::print("{}", *text);
  return kExitDone;
}

}  // namespace
}  // namespace handcast::detect

int main(int argc, char** argv) try {
  using namespace handcast;
  detect::Options options;
  CLI::App app("Finds the 21 landmarks of the hands in pictures.", "handcast detect");
  app.footer(detect::kFooter);
  app.add_option("IMAGE", options.images, "PNG or JPEG pictures")->required();
  app.add_option("--joints", options.joints,
                 "A tracker's joints in the picture: (21,2) px, or (42,2) in -1..1; one a picture")
      ->allow_extra_args(false);
  app.add_option("--side", options.joints_side, "Whose joints they are")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, msg::Side>{{"left", msg::Side::left}, {"right", msg::Side::right}}))
      ->default_str("left");
  app.add_option("--model", options.models,
                 "Folder of the networks' files, see scripts/get-models");
  app.add_option("--backend", options.backend,
                 "onednn or opencv: MediaPipe Hands; own: handcast's own network, where --joints "
                 "says or the palm network finds a hand")
      ->capture_default_str();
  app.add_option("--hands", options.hands, "How many are looked for")
      ->check(CLI::Range(1, 2))
      ->capture_default_str();
  app.add_option("-o,--out", options.output, "Draws each result into this folder");
  app.add_option("--repeat", options.repeat, "Looks this often and tells the median of the times")
      ->check(CLI::Range(1, 100000));
  app.add_flag("--json", options.json, "Prints JSON");
  app.add_flag("--quiet", options.quiet, "No progress line");
  app.set_version_flag("--version", fmt::format("handcast detect {}", version()));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& problem) {
    return app.exit(problem) == 0 ? kExitDone : kExitUsage;
  }
  return detect::detect(options);
} catch (const std::exception& problem) {
  std::fprintf(stderr, "handcast detect: %s\n", problem.what());
  return handcast::kExitRetry;
}
