// SPDX-License-Identifier: Apache-2.0
// handcast detect: the landmark detector on pictures.
#include <fmt/format.h>

#include <map>
#include <string>
#include <vector>

#include "ipc/base/exit_code.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/verb_options.hpp"
#include "services/landmarks/models/landmark_models.hpp"
#include "services/tools/detect/run.hpp"

namespace handcast::detect {
namespace {

const char* const kFooter =
    R"(Each picture is treated as the first image of a stream: a hand is searched at the place of --joints, otherwise at the places that the palm network finds.
Points are pixels of the picture, (0, 0) is the centre of the upper left one; they are as the network defines them, with the lens's distortion.
--out draws bones and landmarks, the square that the network was given (with a thick upper edge) and the tracker's joints as crosses.)";

std::string backend_help() {
  std::string text = "The landmark model.";
  for (const auto& model : landmarks::landmark_models())
    text += fmt::format(" {}: {}", model.name, model.sentence);
  return text;
}

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

static int run_verb(int argc, char** argv) {
  using namespace handcast;
  detect::Options options;
  CLI::App app("Finds the 21 landmarks of the hands in pictures.", "handcast detect");
  app.footer(detect::kFooter);
  app.add_option("IMAGE", options.images, "PNG or JPEG pictures")->required();
  app.add_option("--joints", options.joints,
                 "A tracker's joints in the picture, one .npy file per picture: (21,2) in pixels, "
                 "or (42,2) in -1..1")
      ->allow_extra_args(false);
  app.add_option("--side", options.joints_side, "The side of the hand in --joints")
      ->transform(
          CLI::CheckedTransformer(std::map<std::string, msg::Side>{{"left", msg::Side::left},
                                                                   {"right", msg::Side::right}})
              .description("{left, right}"))
      ->default_str("left");
  app.add_option("--model", options.models,
                 "The folder of MediaPipe's files; scripts/get-models fetches them");
  app.add_option("--backend", options.backend, detect::backend_help())
      ->default_str("mediapipe, or handcast without its files");
  app.add_option("--hands", options.hands, "The largest number of hands")
      ->check(CLI::Range(1, 2))
      ->capture_default_str();
  app.add_option("-o,--out", options.output, "A folder for drawings of the results");
  app.add_option("--repeat", options.repeat,
                 "Repeats each detection and prints the median of the times")
      ->check(CLI::Range(1, 100000));
  app.add_flag("--json", options.json, "Prints JSON");
  app.add_flag("--quiet", options.quiet, "Prints no progress");
  if (const auto code = answered(app, parse_options(app, argc, argv))) return *code;
  return detect::detect(options);
}

int main(int argc, char** argv) {
  return handcast::run_program("handcast detect", argc, argv, run_verb);
}
