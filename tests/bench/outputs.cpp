// SPDX-License-Identifier: Apache-2.0
// Sub-frames: the time to pack them, the rate that a machine holds, and the noise of bit planes.
//   bench_outputs [--goals FILE] [--rate HZ]
// --rate: only 24x1 at this rate.
#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <numeric>
#include <vector>

#include "config/sections/sub_frames.hpp"
#include "config/settings/choice.hpp"
#include "tests/bench/goals.hpp"
#include "tests/bench/outputs_dither.hpp"
#include "tests/bench/outputs_loop.hpp"
#include "tests/bench/percentiles.hpp"

namespace handcast::bench {
namespace {

using config::Packing;

config::Projector settings(Packing packing, double rate_hz) {
  config::Projector projector;
  projector.packing = packing;
  projector.rate_hz = rate_hz;
  return projector;
}

void measure_packing(std::vector<Goal>& goals) {
  fmt::print("packing an output frame of 1024x768, µs\n  {:<15} {:>8} {:>8} {:>14} {:>22} {:>8}\n",
             "", "p50", "p99", "per sub-frame", "after the last drawing", "p99");
  for (const auto packing :
       {Packing::planes_24x1, Packing::planes_8x3, Packing::quadrants_4, Packing::quadrants_12}) {
    const int each = config::sub_frames_of(packing);
    const auto times = draw_sub_frames(settings(packing, 240), 60 * each);
    const double p50 = median(times.pack_us), p99 = percentile(times.pack_us, 0.99);
    fmt::print("  {:<15} {:8.1f} {:8.1f} {:14.1f} {:22.1f} {:8.1f}\n", config::word_of(packing),
               p50, p99, p50 / each, median(times.last_us), percentile(times.last_us, 0.99));
    goals.push_back(
        {fmt::format("packing {} p50", config::word_of(packing)), p50 / 1e3, 0.4, "ms"});
    goals.push_back({fmt::format("packing {} after the last drawing p50", config::word_of(packing)),
                     median(times.last_us) / 1e3, 0.4, "ms"});
  }
}

/// Draws 10,000 sub-frames at a rate and returns how many were missed.
int measure_misses(double rate_hz) {
  constexpr int kSubFrames = 10'000;
  const auto times = draw_sub_frames(settings(Packing::planes_24x1, rate_hz), kSubFrames);
  fmt::print(
      "  {:.0f} sub-frames/s ({:.1f} output frames/s): {} of {} missed, {} of these with their "
      "output frame; begun {:.1f} ms before handing over at p50, {:.1f} in the mean; handed over "
      "{:.0f} µs late at p99; a drawing takes {:.0f} µs (p99 {:.0f})\n",
      rate_hz, times.output_hz, times.missed, times.sub_frames, times.missed_with_frame,
      median(times.lead_ms),
      std::accumulate(times.lead_ms.begin(), times.lead_ms.end(), 0.) /
          static_cast<double>(times.lead_ms.size()),
      percentile(times.late_us, 0.99), median(times.drawing_us),
      percentile(times.drawing_us, 0.99));
  return times.missed;
}

/// Finds a rate at which no sub-frame of 10,000 is missed, from the time of a drawing.
void measure_rate(std::vector<Goal>& goals) {
  const auto some = draw_sub_frames(settings(Packing::planes_24x1, 480), 960);
  const double drawing_us = median(some.drawing_us);
  fmt::print("24x1: a drawing takes {:.0f} µs (p99 {:.0f})\n", drawing_us,
             percentile(some.drawing_us, 0.99));
  for (const double load : {0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3}) {
    const double rate_hz = load * 1e6 / drawing_us;
    if (measure_misses(rate_hz) > 0) continue;
    goals.push_back(
        {"24x1: sub-frames/s without a missed one in 10,000", rate_hz, 500, "Hz", true});
    return;
  }
  goals.push_back({"24x1: sub-frames/s without a missed one in 10,000", 0, 500, "Hz", true});
}

void print_noise(const char* name, const DitherNoise& noise) {
  fmt::print("  {:<22} {:8.2f} {:8.3f} {:8.2f} {:8.2f} {:8.2f} {:8.3f}\n", name, 100 * noise.plane,
             100 * noise.frame, 100 * noise.followed, 100 * noise.worst, 100 * noise.flicker,
             100 * noise.mean_error);
}

void measure_noise(std::vector<Goal>& goals) {
  for (const int planes : {24, 8}) {
    fmt::print(
        "noise of {} planes, RMS in % of the light\n  {:<22} {:>8} {:>8} {:>8} {:>8} {:>8} "
        "{:>8}\n",
        planes, "", "plane", "frame", "followed", "worst", "flicker", "mean");
    const renderer::Dither blue(planes), bayer(planes, bayer_pattern()),
        white(planes, white_noise());
    const DitherNoise ours = noise_of(blue, true);
    print_noise("blue noise", ours);
    print_noise("blue noise, not moved", noise_of(blue, false));
    print_noise("Bayer", noise_of(bayer, true));
    print_noise("Bayer, not moved", noise_of(bayer, false));
    print_noise("random", noise_of(white, true));
    goals.push_back({fmt::format("{} planes: error of the mean light", planes),
                     100 * ours.mean_error, 0.1, "%"});
  }
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  using namespace handcast::bench;
  std::vector<Goal> goals;
  if (argc == 3 && std::strcmp(argv[1], "--rate") == 0) {
    const double rate_hz = std::atof(argv[2]);
    if (rate_hz > 0) measure_misses(rate_hz);
    if (rate_hz <= 0) fmt::print(stderr, "bench_outputs: --rate needs a rate above 0 Hz.\n");
    return rate_hz > 0 ? 0 : 2;
  }
  measure_packing(goals);
  measure_noise(goals);
  measure_rate(goals);
  print_goals(goals);
  const bool has_file = argc == 3 && std::strcmp(argv[1], "--goals") == 0;
  if (has_file && !write_goals(argv[2], goals)) {
    fmt::print(stderr, "bench_outputs: cannot write '{}'.\n", argv[2]);
    return 1;
  }
  return 0;
}
