// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdio>
#include <exception>

#include "ipc/base/command_line.hpp"
#include "services/lab/training/contact_sheet.hpp"

// handcast-training-images: writes training images to standard output.
int main(int argc, char** argv) try {
  using namespace handcast::landmarks::training;
  std::uint64_t seed = 1, first = 0, count = 1000;
  int people = 160, preview = 0;
  std::string picture = "training.png";
  constexpr handcast::CommandLine::Range kAny{0, 1e15};
  handcast::CommandLine line(
      "handcast-training-images",
      "Makes synthetic infrared images of hands with their landmarks for the training; writes them "
      "as a row of Sample structs (sample.hpp) to standard output.");
  line.add("--seed N", seed, "The seed of everything random", kAny);
  line.add("--first N", first, "The number of the first image, to continue an earlier run", kAny);
  line.add("--count N", count, "The number of images", kAny);
  line.add("--people N", people, "The number of different hands", {1, 1000});
  line.add("--preview N", preview, "Instead draws this number of images with their labels",
           {0, 1000});
  line.add("--picture FILE.png", picture, "The file of --preview");
  if (const auto code = line.answered(argc, argv)) return *code;

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
