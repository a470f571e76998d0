// SPDX-License-Identifier: Apache-2.0
// How near the drawn frames come to a supersampled reference, with `content.smooth` and without.
//   bench_frame_pictures [--goals FILE]
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "tests/bench/goals.hpp"
#include "tests/bench/picture_quality.hpp"

int main(int argc, char** argv) {
  using namespace handcast::bench;
  if (argc != 1 && (argc != 3 || std::strcmp(argv[1], "--goals") != 0)) {
    fmt::print(stderr, "usage: bench_frame_pictures [--goals FILE]\n");
    return 2;
  }
  const PictureQuality quality = measure_picture_quality(40);
  if (!quality.error.empty()) {
    fmt::print("pictures: not measured: {}\n", quality.error);
    return 0;
  }
  fmt::print("structural similarity to the 16x supersampled frame\n  {:<22} {:>8} {:>8}\n", "",
             "hard", "smooth");
  double least = 1;
  for (const auto& [frame, hard, smooth] : quality.similarity) {
    fmt::print("  {:<22} {:8.4f} {:8.4f}\n", frame, hard, smooth);
    least = std::min(least, smooth);
  }
  fmt::print("flicker of lines that move 0.07 px a frame, RMS levels: hard {:.2f}, smooth {:.2f}\n",
             quality.hard_flicker, quality.smooth_flicker);
  const std::vector<Goal> goals{
      {"structural similarity, least of the frames", least, 0.97, "", true},
      {"flicker, smooth / hard", quality.smooth_flicker / quality.hard_flicker, 0.5, "times"}};
  print_goals(goals);
  if (argc == 3 && !write_goals(argv[2], goals)) {
    fmt::print(stderr, "bench_frame_pictures: cannot write '{}'.\n", argv[2]);
    return 1;
  }
  return 0;
}
