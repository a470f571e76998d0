// SPDX-License-Identifier: Apache-2.0
// What it costs to keep images: candidates for the packing of `handcast record`, on images of the
// twin and on real ones (HANDCAST_DATA/real).
//   bench_devices_recording [--goals FILE]
#include <fmt/format.h>
#include <libdeflate.h>
#include <time.h>
#include <zlib.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/media/picture.hpp"
#include "services/lab/twin/twin.hpp"
#include "services/recording/packed_image.hpp"
#include "tests/bench/goals.hpp"
#include "tests/bench/percentiles.hpp"

namespace handcast::bench {
namespace {

using Image = renderer::Image<std::uint8_t>;
using Pixels = std::vector<std::uint8_t>;

constexpr double kRate_hz = 525;
constexpr int kTwinImages = 30, kRepeats = 5;

/// Of this thread: the machine may be busy.
double cpu_us() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e6 + static_cast<double>(time.tv_nsec) * 1e-3;
}

Pixels less_upper(const Image& image) {
  Pixels out(image.pixels().begin(), image.pixels().end());
  const auto width = static_cast<std::size_t>(image.width());
  for (std::size_t i = out.size(); i-- > width;)
    out[i] = static_cast<std::uint8_t>(out[i] - out[i - width]);
  return out;
}
Pixels plain(const Image& image) { return {image.pixels().begin(), image.pixels().end()}; }

std::size_t by_zlib(const Pixels& bytes, int level, int strategy) {
  z_stream stream{};
  deflateInit2(&stream, level, Z_DEFLATED, 15, 8, strategy);
  Pixels out(deflateBound(&stream, bytes.size()));
  stream.next_in = const_cast<Bytef*>(bytes.data());
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  const auto size = stream.total_out;
  deflateEnd(&stream);
  return size;
}

std::size_t by_libdeflate(const Pixels& bytes, int level) {
  auto* compressor = libdeflate_alloc_compressor(level);
  Pixels out(libdeflate_zlib_compress_bound(compressor, bytes.size()));
  const auto size =
      libdeflate_zlib_compress(compressor, bytes.data(), bytes.size(), out.data(), out.size());
  libdeflate_free_compressor(compressor);
  return size;
}

struct Candidate {
  std::string_view name;
  std::function<std::size_t(const Image&)> pack;
};

std::size_t by_handcast(const Image& image) {
  static recording::ImagePacker packer;
  static recording::Bytes packed;
  packed.clear();
  packer.append(
      image.pixels(),
      {static_cast<std::uint32_t>(image.width()), static_cast<std::uint32_t>(image.height()), 1},
      packed);
  return packed.size();
}

const std::vector<Candidate> kCandidates{
    {"handcast", by_handcast},
    {"zlib 1, plain",
     [](const Image& image) { return by_zlib(plain(image), 1, Z_DEFAULT_STRATEGY); }},
    {"zlib 1, upper",
     [](const Image& image) { return by_zlib(less_upper(image), 1, Z_DEFAULT_STRATEGY); }},
    {"zlib Huffman, upper",
     [](const Image& image) { return by_zlib(less_upper(image), 1, Z_HUFFMAN_ONLY); }},
    {"zlib runs, upper", [](const Image& image) { return by_zlib(less_upper(image), 1, Z_RLE); }},
    {"zlib 6, upper",
     [](const Image& image) { return by_zlib(less_upper(image), 6, Z_DEFAULT_STRATEGY); }},
    {"libdeflate 1, plain", [](const Image& image) { return by_libdeflate(plain(image), 1); }},
    {"libdeflate 1, upper", [](const Image& image) { return by_libdeflate(less_upper(image), 1); }},
};

struct Cost {
  double us = 0, ratio = 0, bytes = 0;
};

Cost cost_of(const Candidate& candidate, const std::vector<Image>& images) {
  std::vector<double> times_us;
  double in = 0, out = 0;
  for (int repeat = 0; repeat < kRepeats; ++repeat)
    for (const auto& image : images) {
      const double begin_us = cpu_us();
      const auto size = candidate.pack(image);
      times_us.push_back(cpu_us() - begin_us);
      in += static_cast<double>(image.pixels().size());
      out += static_cast<double>(size);
    }
  return {median(times_us), in / out, out / static_cast<double>(times_us.size())};
}

Cost print_table(const std::string& title, const std::vector<Image>& images) {
  Cost first;
  fmt::print("\n{} ({} x {} px, {} images)\n{:<22} {:>7} {:>12} {:>22} {:>22}\n", title,
             images[0].width(), images[0].height(), images.size(), "", "ratio", "us per image",
             "MB/min at 525 Hz", "cores at 525 Hz");
  for (const auto& candidate : kCandidates) {
    const auto cost = cost_of(candidate, images);
    if (&candidate == &kCandidates.front()) first = cost;
    fmt::print("{:<22} {:>7.2f} {:>12.0f} {:>22.0f} {:>22.2f}\n", candidate.name, cost.ratio,
               cost.us, cost.bytes * kRate_hz * 60e-6, cost.us * kRate_hz * 1e-6);
  }
  return first;
}

std::vector<Image> twin_images() {
  config::Rig rig;
  const auto calibration = calib::reference_rig();
  const auto twin = twin::Twin::create(rig, calibration);
  std::vector<Image> images;
  for (std::uint64_t k = 0; twin && k < kTwinImages; ++k) {
    images.emplace_back(calibration.camera.width_px, calibration.camera.height_px);
    (*twin)->camera_image(50 * k, images.back().view());
  }
  return images;
}

std::vector<Image> real_images() {
  std::vector<Image> images;
  const char* data = std::getenv("HANDCAST_DATA");
  std::error_code absent;
  if (data)
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(data) / "real", absent))
      if (entry.path().extension() == ".png")
        if (auto image = renderer::read_camera_picture(entry.path()))
          images.push_back(std::move(image->grey));
  return images;
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  using namespace handcast::bench;
  const auto cost = print_table("images of the twin", twin_images());
  if (const auto real = real_images(); !real.empty())
    print_table("real images", real);
  else
    fmt::print("\nno real images: HANDCAST_DATA/real\n");
  const std::vector<Goal> goals{{"recording: MB/min of camera images at 525 Hz",
                                 cost.bytes * kRate_hz * 60e-6, 1000, "MB/min"},
                                {"recording: cores that pack camera images at 525 Hz",
                                 cost.us * kRate_hz * 1e-6, 0.5, "cores"}};
  print_goals(goals);
  if (argc == 3 && std::string_view(argv[1]) == "--goals" && !write_goals(argv[2], goals)) return 1;
}
