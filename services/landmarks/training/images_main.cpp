// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "services/landmarks/training/contact_sheet.hpp"

/// Writes training images to standard output until nobody reads them.
int main(int argc, char** argv) try {
  using namespace handcast::landmarks::training;
  std::uint64_t seed = 1, first = 0, count = 1000;
  int people = 160, preview = 0;
  std::string picture = "training.png";
  CLI::App app{
      "Synthetic infrared images of hands with their landmarks, for training: Sample structs "
      "(sample.hpp) one after another."};
  app.add_option("--seed", seed, "Everything random is drawn from this number");
  app.add_option("--first", first,
                 "Number of the first image: to go on where an earlier run ended");
  app.add_option("--count", count, "How many images");
  app.add_option("--people", people, "How many different hands")->check(CLI::Range(1, 1000));
  app.add_option("--preview", preview, "Draw so many images with their labels instead")
      ->check(CLI::Range(0, 1000));
  app.add_option("--picture", picture, "The file to draw into");
  CLI11_PARSE(app, argc, argv);

  auto generator = Generator::create(people, seed);
  if (!generator)
    return fmt::print(stderr, "handcast-training-images: {}\n", generator.error().what), 1;
  if (preview > 0) {
    const auto written = write_contact_sheet(*generator, preview, picture);
    if (!written) fmt::print(stderr, "handcast-training-images: {}\n", written.error().what);
    return written ? 0 : 1;
  }
  for (std::uint64_t i = first; i < first + count; ++i)
    if (std::fwrite(&generator->make(i), sizeof(Sample), 1, stdout) != 1) return 0;
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "handcast-training-images: %s\n", error.what());
  return 1;
}
