// SPDX-License-Identifier: Apache-2.0
// What a picture of content of 640 x 400 texels costs, by what makes it. No goals.
#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <string_view>
#include <thread>
#include <vector>

#include "renderer/media/colour_film.hpp"
#include "renderer/media/film.hpp"
#include "renderer/media/jpeg.hpp"
#include "services/content/blend.hpp"
#include "services/content/scaled.hpp"
#include "services/content/source.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/scratch.hpp"

using namespace handcast;
using namespace handcast::content;
using renderer::Texture;

namespace {

constexpr int kWidth = 640, kHeight = 400;

void print(std::string_view name, const std::vector<double>& times_us) {
  fmt::print("{:40} median {:8.1f} us  p99 {:8.1f} us\n", name, bench::median(times_us),
             bench::percentile(times_us, 0.99));
}

void measure(std::string_view name, int runs, const std::function<void()>& work) {
  std::vector<double> times_us;
  for (int run = 0; run < runs; ++run) times_us.push_back(bench::timed_us(work));
  print(name, times_us);
}

Texture noise(int width, int height, std::uint32_t seed) {
  Texture picture(width, height);
  for (auto& pixel : picture.pixels()) {
    seed = seed * 1664525u + 1013904223u;
    const std::uint32_t alpha = seed >> 24, level = alpha * (seed >> 16 & 255) / 255;
    pixel = alpha << 24 | level * 0x010101u;
  }
  return picture;
}

void measure_blends() {
  const auto above = noise(kWidth, kHeight, 1);
  auto below = noise(kWidth, kHeight, 2);
  Texture out(kWidth, kHeight);
  const auto names = blend_names();
  for (std::size_t i = 0; i < names.size(); ++i)
    measure("blend " + names[i], 500, [&] {
      blend(std::as_const(below).view(), above.view(), static_cast<Blend>(i), 0.8, out);
    });
  measure("opacity of a filter", 500,
          [&] { mix(std::as_const(below).view(), above.view(), 0.4, out); });
  measure("fade", 500, [&] { fade(std::as_const(below).view(), above.view(), 0.4, out); });
}

void measure_scaling() {
  for (const auto& [width, height] : {std::pair{1920, 1080}, {320, 200}}) {
    const auto picture = noise(width, height, 3);
    measure(fmt::format("scale from {} x {}", width, height), 100,
            [&] { (void)scaled(picture.view(), kWidth, kHeight); });
  }
}

/// A gradient that moves, with a little noise. Its colours have all their samples (4:4:4), which
/// takes five times as long to scale as the usual quarter.
void write_film(const std::string& file, int width, int height, int frames) {
  auto film = renderer::Film::create(file, width, height);
  if (!film) return fmt::print("{}\n", film.error().what);
  for (int i = 0; i < frames; ++i) {
    Texture picture(width, height);
    std::uint32_t seed = 1;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        seed = seed * 1664525u + 1013904223u;
        const auto level = static_cast<std::uint32_t>((x / 4 + 5 * i) & 255);
        picture.at(x, y) = 0xff000000u | level << 8 | (seed >> 28) << 16 | (255 - level);
      }
    (void)film->add(renderer::jpeg_of(picture.view()), i * 33'333'333ll);
  }
}

void measure_film(int width, int height) {
  const test::Scratch scratch;
  const std::string file = scratch.path() / "a.avi";
  write_film(file, width, height, 60);
  const std::atomic<bool> is_over = false;
  auto film = renderer::open_colour_film({.address = file}, is_over);
  if (!film) return fmt::print("{}\n", film.error().what);
  Texture out(kWidth, kHeight);
  measure(fmt::format("film {} x {} decode (its thread)", width, height), 60,
          [&] { (void)(*film)->next(); });
  (void)(*film)->seek(0);
  (void)(*film)->next();
  measure(fmt::format("film {} x {} scale (its thread)", width, height), 100,
          [&] { (void)(*film)->read(out); });

  Opening opening;
  opening.element = {"film", file, {}};
  auto source = open_source(opening);
  if (!source) return fmt::print("{}\n", source.error().what);
  std::vector<double> times_us;
  Moment moment;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 120; ++i) {
    std::this_thread::sleep_until(begin + i * std::chrono::microseconds(16'667));
    moment.time_s = i / 60.0;
    times_us.push_back(bench::timed_us([&] { (void)(*source)->draw(moment, {}, out); }));
  }
  print(fmt::format("film {} x {} draw, at 60 Hz", width, height), times_us);
}

void measure_source(std::string_view name, config::ContentElement element, const char* changed,
                    const renderer::HandMesh& hand) {
  Opening opening;
  opening.element = std::move(element);
  opening.meshes = {&hand, &hand};
  auto source = open_source(opening);
  if (!source) return fmt::print("{}: {}\n", name, source.error().what);
  Texture out(kWidth, kHeight);
  int run = 0;
  measure(name, 60, [&] {
    if (changed) (void)(*source)->set(changed, ++run % 2 ? "0.4" : "0.5");
    (void)(*source)->draw({}, {}, out);
  });
}

}  // namespace

int main() {
  measure_blends();
  measure_scaling();
  measure_film(1280, 720);
  measure_film(1920, 1080);
  const auto hand = renderer::load_hand_or_default({}, Side::left);
  if (hand) {
    measure_source("text that changes", {"text", "a line of text", {}}, "x", *hand);
    measure_source("text that stays", {"text", "a line of text", {}}, nullptr, *hand);
    measure_source("pattern bars that change", {"pattern", "bars", {}}, "value3", *hand);
  }
  return 0;
}
