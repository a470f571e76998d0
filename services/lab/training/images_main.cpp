// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "services/lab/training/contact_sheet.hpp"

// handcast-training-images: writes training images to standard output.
int main(int argc, char** argv) try {
  using namespace handcast::landmarks::training;
  std::uint64_t seed = 1, first = 0, count = 1000;
  int people = 160, preview = 0;
  std::string picture = "training.png";
  CLI::App app{
      "Makes synthetic infrared images of hands with their landmarks for the training; writes them "
      "as a row of Sample structs (sample.hpp) to standard output."};
  app.add_option("--seed", seed, "The seed of everything random");
  app.add_option("--first", first, "The number of the first image, to continue an earlier run");
  app.add_option("--count", count, "The number of images");
  app.add_option("--people", people, "The number of different hands")->check(CLI::Range(1, 1000));
  app.add_option("--preview", preview, "Instead draws this number of images with their labels")
      ->check(CLI::Range(0, 1000));
  app.add_option("--picture", picture, "The file of --preview");
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
