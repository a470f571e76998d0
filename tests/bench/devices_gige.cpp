// SPDX-License-Identifier: Apache-2.0
// A GigE Vision camera: rate, time from its stamp to the published image, error of the clock map,
// losses, and the time until a camera that was away is back. The camera is Aravis's fake one on the
// loopback, in this process, so both share its cores.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <thread>

#include "calib/clock_map.hpp"
#include "ipc/base/log.hpp"
#include "services/camera/aravis/pixels.hpp"
#include "services/camera/camera.hpp"
#include "services/lab/twin/twin.hpp"
#include "tests/bench/goals.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/services/camera/aravis/fake_camera.hpp"

namespace handcast::bench {
namespace {

using namespace std::chrono_literals;

constexpr double kRate_hz = 525;

/// The first images of the twin, one after the other, each with the time at which it was sent in
/// its first bytes.
class TwinImages {
 public:
  TwinImages(const config::Rig& rig, const calib::Calibration& calibration) {
    auto twin = twin::Twin::create(rig, calibration);
    if (!twin) return;
    for (std::uint64_t k = 0; k < 32; ++k) {
      images_.emplace_back(calibration.camera.width_px, calibration.camera.height_px);
      (*twin)->camera_image(k, images_.back().view());
    }
  }
  void fill(std::uint8_t* pixels, std::size_t bytes) {
    const auto& image = images_[next_++ % images_.size()];
    std::memcpy(pixels, image.pixels().data(), std::min(bytes, image.pixels().size()));
    const std::int64_t sent_ns = now_ns();
    std::memcpy(pixels, &sent_ns, sizeof(sent_ns));
  }

 private:
  std::vector<renderer::Image<std::uint8_t>> images_;
  std::size_t next_ = 0;
};

struct Arrivals {
  std::vector<std::int64_t> sent_ns, published_ns;
  std::uint64_t lost = 0, first_id = 0, last_id = 0;
};

/// The camera of a rig, at the loopback.
class LoopbackCamera {
 public:
  LoopbackCamera() : calibration_(calib::reference_rig()), images_(rig_, calibration_) {
    rig_.camera.backend = "aravis";
    rig_.camera.rate_hz = kRate_hz;
    rig_.camera.exposure_ms = 1.85;
    rig_.camera.aravis.device = "127.0.0.1";
    rig_.camera.aravis.packet_bytes = 8000;
    memory_.resize(msg::CameraFrame::bytes(width(), height()));
  }

  void plug_in() {
    fake_ = std::make_unique<test::FakeCamera>(
        [this](std::uint8_t* pixels, std::size_t bytes) { images_.fill(pixels, bytes); });
  }
  void unplug() { fake_.reset(); }
  test::FakeCamera& fake() { return *fake_; }

  bool open() {
    auto opened = camera::open_camera(rig_, calibration_, now_ns());
    if (!opened) fmt::print(stderr, "{}\n", opened.error().what);
    if (opened) camera_ = std::move(*opened);
    return static_cast<bool>(camera_);
  }

  bool capture(std::chrono::nanoseconds within) {
    frame().lost = {};
    return static_cast<bool>(camera_->capture(frame(), width() * height(), Deadline::in(within)));
  }

  Arrivals run(double seconds) {
    Arrivals arrivals;
    for (const auto end = Deadline::in(std::chrono::milliseconds(std::lround(1e3 * seconds)));
         !end.passed();) {
      if (!capture(100ms)) continue;
      const std::int64_t published_ns = now_ns();
      std::int64_t sent_ns = 0;
      std::memcpy(&sent_ns, frame().pixels(), sizeof(sent_ns));
      if (arrivals.sent_ns.empty())
        arrivals.first_id = frame().header.frame_id;
      else
        arrivals.lost += frame().lost.missing + frame().lost.incomplete + frame().lost.underrun +
                         frame().lost.skipped;
      arrivals.last_id = frame().header.frame_id;
      arrivals.sent_ns.push_back(sent_ns);
      arrivals.published_ns.push_back(published_ns);
    }
    return arrivals;
  }

 private:
  std::size_t width() const { return static_cast<std::size_t>(calibration_.camera.width_px); }
  std::size_t height() const { return static_cast<std::size_t>(calibration_.camera.height_px); }
  msg::CameraFrame& frame() { return *reinterpret_cast<msg::CameraFrame*>(memory_.data()); }

  config::Rig rig_;
  calib::Calibration calibration_;
  TwinImages images_;
  std::vector<std::byte> memory_;
  std::unique_ptr<test::FakeCamera> fake_;
  std::unique_ptr<camera::Camera> camera_;
};

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

std::vector<double> latencies_ms(const Arrivals& arrivals) {
  std::vector<double> ms;
  for (std::size_t i = 0; i < arrivals.sent_ns.size(); ++i)
    ms.push_back(ns_to_ms(arrivals.published_ns[i] - arrivals.sent_ns[i]));
  return ms;
}

/// The errors of a map over arrivals that were measured, as if the camera's clock ran `drift` fast.
/// The least delay that there was counts as the true one. Without the first 2 s.
std::vector<double> map_errors_us(const Arrivals& arrivals, double drift) {
  const auto all_ms = latencies_ms(arrivals);
  const double least_ms = *std::ranges::min_element(all_ms);
  calib::ClockMap map;
  std::vector<double> errors_us;
  for (std::size_t i = 0; i < arrivals.sent_ns.size(); ++i) {
    const auto since_ns = arrivals.sent_ns[i] - arrivals.sent_ns.front();
    const auto device_ns = since_ns + std::llround(drift * static_cast<double>(since_ns));
    map.add(device_ns, arrivals.published_ns[i]);
    if (since_ns < 2'000'000'000) continue;
    const auto mapped_ns = map.earliest_arrival(device_ns).ns;
    errors_us.push_back(std::abs(ns_to_us(mapped_ns - arrivals.sent_ns[i]) - 1e3 * least_ms));
  }
  return errors_us;
}

void print_formats() {
  using config::PixelFormat;
  constexpr std::size_t kPixels = 720 * 540;
  std::vector<std::uint8_t> packed(2 * kPixels, 77), grey(kPixels);
  fmt::print("to 8 bits, 720 x 540, us        p50      p99\n");
  for (const auto format : {PixelFormat::mono8, PixelFormat::mono10, PixelFormat::mono10_p,
                            PixelFormat::mono12, PixelFormat::mono12_p}) {
    std::vector<double> us;
    for (int i = 0; i < 300; ++i) {
      const std::int64_t begin_ns = now_ns();
      camera::to_grey(format, packed, grey);
      us.push_back(ns_to_us(now_ns() - begin_ns));
    }
    fmt::print("  {:<24} {:8.1f} {:8.1f}\n", words_of(format)[static_cast<std::size_t>(format)],
               median(us), percentile(us, 0.99));
  }
}

std::uint64_t lost_in(const Arrivals& of) {
  return of.last_id - of.first_id + 1 - of.sent_ns.size();
}

/// Number of images that were lost without being counted.
double print_losses(const char* what, const Arrivals& arrivals) {
  fmt::print("{}: {} images, {} lost, {} of them counted\n", what, arrivals.sent_ns.size(),
             lost_in(arrivals), arrivals.lost);
  return std::abs(static_cast<double>(lost_in(arrivals)) - static_cast<double>(arrivals.lost));
}

void measure_times(const Arrivals& arrivals, std::vector<Goal>& goals) {
  const auto ms = latencies_ms(arrivals);
  const double held_hz = static_cast<double>(arrivals.sent_ns.size() - 1) /
                         ns_to_seconds(arrivals.sent_ns.back() - arrivals.sent_ns.front());
  fmt::print("{:.0f} Hz of {:.0f} Hz; stamp to published: mean {:.3f} ms, p50 {:.3f}, p99 {:.3f}\n",
             held_hz, kRate_hz, mean_of(ms), median(ms), percentile(ms, 0.99));
  goals.push_back({"GigE: stamp to published, mean", mean_of(ms), 0.7, "ms"});
  for (const double drift : {50e-6, -50e-6}) {
    const auto errors_us = map_errors_us(arrivals, drift);
    fmt::print("clock map, {:+.0f} ppm: error p50 {:.1f} us, p99 {:.1f} us\n", 1e6 * drift,
               median(errors_us), percentile(errors_us, 0.99));
    goals.push_back({fmt::format("clock map at {:+.0f} ppm, error p99", 1e6 * drift),
                     percentile(errors_us, 0.99), 50, "us"});
  }
}

void measure_returns(LoopbackCamera& camera, std::vector<Goal>& goals) {
  std::vector<double> back_ms;
  for (int i = 0; i < 9; ++i) {
    camera.unplug();
    std::this_thread::sleep_for(300ms);
    while (camera.capture(1ms)) {  // the last one from before
    }
    camera.plug_in();
    const std::int64_t back_ns = now_ns();
    while (!camera.capture(50ms)) {
    }
    back_ms.push_back(ns_to_ms(now_ns() - back_ns));
    camera.run(0.5);
  }
  fmt::print("an image after the camera's return: p50 {:.0f} ms, max {:.0f} ms\n", median(back_ms),
             percentile(back_ms, 1));
  goals.push_back({"GigE: image after the return, p50", median(back_ms), 100, "ms"});
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  using namespace handcast::bench;
  handcast::log::set_level(handcast::log::Level::error);
  print_formats();
  LoopbackCamera camera;
  camera.plug_in();
  if (!camera.open()) return 1;
  camera.run(0.2);

  std::vector<Goal> goals;
  const auto arrivals = camera.run(12);
  measure_times(arrivals, goals);
  double uncounted = print_losses("all packets", arrivals);
  camera.fake().lose(0.001);
  uncounted += print_losses("0.1 % of the packets lost", camera.run(4));
  goals.push_back({"GigE: lost images that are not counted", uncounted, 0, ""});
  camera.fake().lose(0);
  measure_returns(camera, goals);

  print_goals(goals);
  const bool has_file = argc == 3 && std::strcmp(argv[1], "--goals") == 0;
  if (has_file && !write_goals(argv[2], goals)) {
    fmt::print(stderr, "bench_devices_gige: cannot write '{}'.\n", argv[2]);
    return 1;
  }
  return 0;
}
