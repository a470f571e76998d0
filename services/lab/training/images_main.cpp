// SPDX-License-Identifier: Apache-2.0
// handcast-training-images: writes training images to standard output.

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>

#include "ipc/base/command_line.hpp"
#include "ipc/base/log.hpp"
#include "renderer/media/picture.hpp"
#include "services/lab/training/generator.hpp"

namespace handcast::landmarks::training {
namespace {

constexpr int kZoom = 2, kColumns = 10, kTile = handcast_network::kSide_px * kZoom;

std::uint32_t colour(int red, int green, int blue) {
  return 0xff000000u | static_cast<std::uint32_t>(red | green << 8 | blue << 16);
}

void draw_point(renderer::Texture& sheet, int left, int top, glm::vec2 place, std::uint32_t value) {
  const int x = static_cast<int>(place.x * kTile), y = static_cast<int>(place.y * kTile);
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      if (x + dx >= 0 && x + dx < kTile && y + dy >= 0 && y + dy < kTile)
        sheet.at(left + x + dx, top + y + dy) = value;
}

void draw_sample(renderer::Texture& sheet, int left, int top, const Sample& sample) {
  for (int y = 0; y < kTile; ++y)
    for (int x = 0; x < kTile; ++x) {
      const auto row = static_cast<std::size_t>(y / kZoom),
                 column = static_cast<std::size_t>(x / kZoom);
      const int grey = sample.image[row * handcast_network::kSide_px + column];
      sheet.at(left + x, top + y) = colour(grey, grey, grey);
    }
  for (std::size_t i = 0; i < sample.truth.size(); ++i) {
    if (sample.has_tracker) draw_point(sheet, left, top, sample.tracker[i], colour(255, 40, 40));
    if (sample.has_hand)
      draw_point(sheet, left, top, sample.truth[i],
                 sample.visible[i] ? colour(60, 255, 60) : colour(0, 120, 200));
  }
}

/// Writes a picture of the first `count` images of the generator in rows of ten: true landmarks
/// green, hidden ones blue, the tracker's joints red. Errors: unavailable.
Result<void> write_contact_sheet(Generator& generator, int count,
                                 const std::filesystem::path& file) {
  renderer::Texture sheet(kColumns * kTile, (count + kColumns - 1) / kColumns * kTile,
                          colour(0, 0, 0));
  for (int i = 0; i < count; ++i)
    draw_sample(sheet, i % kColumns * kTile, i / kColumns * kTile,
                generator.make(static_cast<std::uint64_t>(i)));
  return renderer::write_png(file, sheet.view());
}

}  // namespace

}  // namespace handcast::landmarks::training

int main(int argc, char** argv) try {
  using namespace handcast::landmarks::training;
  std::uint64_t seed = 1, first = 0, count = 1000;
  int people = 200, preview = 0;
  std::string picture = "training.png";
  constexpr handcast::CommandLine::Range kAny{0, 1e15};
  handcast::CommandLine line(
      "handcast-training-images",
      "Makes synthetic infrared images of hands with their landmarks for the training; writes them "
      "as a row of Sample structs (film.hpp) to standard output.");
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
    return fmt::print(stderr, "handcast-training-images: {}\n",
                      handcast::printable(generator.error().what)),
           1;
  if (preview > 0) {
    const auto written = write_contact_sheet(*generator, preview, picture);
    if (!written)
      fmt::print(stderr, "handcast-training-images: {}\n",
                 handcast::printable(written.error().what));
    return written ? 0 : 1;
  }
  for (std::uint64_t i = first; i < first + count; ++i)
    if (std::fwrite(&generator->make(i), sizeof(Sample), 1, stdout) != 1) return 0;
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "handcast-training-images: %s\n", error.what());
  return 1;
}
