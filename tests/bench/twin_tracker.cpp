// SPDX-License-Identifier: Apache-2.0
// How far the twin's tracker is off: the finger tips that it reports, projected into the camera,
// against the true ones, per motion. To be compared with four real captures, on which a person
// marked 19 tips.
//   bench_twin_tracker [RIG.toml] [--set PATH=VALUE]... [--goals FILE]
// The default rig is config/rigs/twin.toml. Recordings are read from HANDCAST_DATA/lmc if they are
// there.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "services/lab/twin/twin.hpp"
#include "services/tools/detect/picture.hpp"
#include "tests/bench/goals.hpp"

namespace handcast::bench {
namespace {

using Point = std::complex<double>;

constexpr std::array<int, 5> kTipLandmarks{4, 8, 12, 16, 20};
constexpr int kSeeds = 10;
constexpr double kSeconds = 8, kStep_s = 0.05;
/// The captures are enlarged: 1024 px for 720 of the camera.
constexpr int kCaptureWidth_px = 1024, kCaptureHeight_px = 768;
constexpr double kCameraPerCapture = 720.0 / kCaptureWidth_px;
/// Squares of the error of the tips of one sample.
struct Squares {
  double all = 0, shifted = 0, similar = 0;
};

Squares squares_of(const std::vector<Point>& seen, const std::vector<Point>& truth) {
  const auto count = static_cast<double>(seen.size());
  Point seen_mean, true_mean, turn;
  double spread = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    seen_mean += seen[i] / count;
    true_mean += truth[i] / count;
  }
  for (std::size_t i = 0; i < seen.size(); ++i) {
    turn += std::conj(seen[i] - seen_mean) * (truth[i] - true_mean);
    spread += std::norm(seen[i] - seen_mean);
  }
  turn /= spread;
  Squares squares;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Point s = seen[i] - seen_mean, t = truth[i] - true_mean;
    squares.all += std::norm(seen[i] - truth[i]) / count;
    squares.shifted += std::norm(s - t) / count;
    squares.similar += std::norm(turn * s - t) / count;
  }
  return squares;
}

/// The errors of a motion, over seeds.
struct Errors {
  std::vector<double> tips_px;
  Squares sum;
  double samples = 0;

  double rms(double Squares::*part) const { return std::sqrt(sum.*part / samples); }
  void add(const Errors& more) {
    tips_px.insert(tips_px.end(), more.tips_px.begin(), more.tips_px.end());
    sum.all += more.sum.all;
    sum.shifted += more.sum.shifted;
    sum.similar += more.sum.similar;
    samples += more.samples;
  }
};

void add_tips(const std::vector<Point>& seen_px, const std::vector<Point>& true_px,
              Errors& errors) {
  for (std::size_t i = 0; i < seen_px.size(); ++i)
    errors.tips_px.push_back(std::abs(seen_px[i] - true_px[i]));
  const auto squares = squares_of(seen_px, true_px);
  errors.sum.all += squares.all;
  errors.sum.shifted += squares.shifted;
  errors.sum.similar += squares.similar;
  ++errors.samples;
}

void add_sample(const twin::Twin& twin, const calib::Calibration& calibration, std::uint64_t k,
                Errors& errors) {
  const auto sample = twin.tracker_sample(k).poses;
  for (std::uint32_t i = 0; i < sample.count; ++i) {
    const auto truth = twin.landmarks(sample.hands[i].side, twin.tracker_time_ns(k));
    if (!truth) continue;
    std::vector<Point> seen_px, true_px;
    for (const int tip : kTipLandmarks) {
      const auto& at = sample.hands[i].joints[msg::kJointOfLandmark[tip]].position_m;
      const auto px = calibration.camera.project(
          glm::dvec3(calibration.camera_from_tracker * glm::dvec4(at[0], at[1], at[2], 1)));
      seen_px.emplace_back(px.x, px.y);
      true_px.emplace_back((*truth)[tip].x, (*truth)[tip].y);
    }
    add_tips(seen_px, true_px, errors);
  }
}

/// The tracker of the paper's authors on their captures, against the tips that a person marked.
std::optional<Errors> errors_of_captures(const std::filesystem::path& data) {
  std::ifstream file("services/lab/training/real_tips.json");
  const auto marks = nlohmann::json::parse(file, nullptr, false);
  if (marks.is_discarded()) return std::nullopt;
  Errors errors;
  for (const auto& [capture, tips] : marks.items()) {
    const auto joints = detect::read_joints(data / "real" / (capture + "_joints_2d_left.npy"),
                                            kCaptureWidth_px, kCaptureHeight_px);
    if (!joints) return std::nullopt;
    std::vector<Point> seen_px, true_px;
    for (const auto& [tip, mark] : tips.items()) {
      const auto& at = (*joints)[std::stoul(tip)];
      seen_px.push_back(kCameraPerCapture * Point(at.x, at.y));
      true_px.push_back(kCameraPerCapture * Point(mark[0], mark[1]));
    }
    add_tips(seen_px, true_px, errors);
  }
  return errors;
}

Result<Errors> errors_of(config::Rig rig, const std::string& motion) {
  rig.twin.motion = motion;
  Errors errors;
  for (rig.twin.seed = 1; rig.twin.seed <= kSeeds; ++rig.twin.seed) {
    const auto calibration = calib::load_calibration(rig.calibration);
    if (!calibration) return tl::make_unexpected(calibration.error());
    const auto twin = twin::Twin::create(rig, *calibration);
    if (!twin) return tl::make_unexpected(twin.error());
    const auto step =
        std::max<std::uint64_t>(1, static_cast<std::uint64_t>(kStep_s * rig.twin.tracker.rate_hz));
    for (std::uint64_t k = 0; ns_to_seconds((*twin)->tracker_time_ns(k)) < kSeconds; k += step)
      add_sample(**twin, *calibration, k, errors);
  }
  return errors;
}

void print_row(const std::string& name, Errors errors) {
  const auto p95 = errors.tips_px.begin() +
                   static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(errors.tips_px.size()));
  std::ranges::nth_element(errors.tips_px, p95);
  double mean = 0;
  for (const double px : errors.tips_px) mean += px / static_cast<double>(errors.tips_px.size());
  fmt::print("{:28} {:6.1f} {:6.1f} {:6.1f} {:10.1f} {:12.1f}\n", name, mean,
             errors.rms(&Squares::all), *p95, errors.rms(&Squares::shifted),
             errors.rms(&Squares::similar));
}

std::filesystem::path data_folder() {
  const char* data = std::getenv("HANDCAST_DATA");
  return data ? data : "../shared/data";
}

std::vector<std::string> motions() {
  std::vector<std::string> names;
  for (const char* name : {"wave", "open_close", "rotate", "pinch", "shake", "two_hands", "fist",
                           "point_at_camera", "cross_fingers", "show"})
    names.push_back(std::string("builtin:") + name);
  const char* data = std::getenv("HANDCAST_DATA");
  const std::filesystem::path folder =
      std::filesystem::path(data ? data : "../shared/data") / "lmc";
  for (const char* name : {"translation", "rotation", "deformation", "all_5s"})
    if (std::filesystem::exists(folder / name)) names.push_back((folder / name).string());
  return names;
}

int run(const std::string& rig_file, const std::vector<std::string>& settings,
        const std::string& goals_file) {
  const auto rig = config::load_rig(rig_file, settings);
  if (!rig) {
    fmt::print(stderr, "{}\n", rig.error().what);
    return 1;
  }
  fmt::print("{:28} {:>6} {:>6} {:>6} {:>10} {:>12}\n", "tips of the tracker, px", "mean", "RMS",
             "p95", "- shift", "- similarity");
  if (const auto captures = errors_of_captures(data_folder()))
    print_row("four real captures", *captures);
  else
    fmt::print("no real captures in {}; HANDCAST_DATA names another folder\n",
               (data_folder() / "real").string());
  Errors all;
  for (const auto& motion : motions()) {
    const auto errors = errors_of(*rig, motion);
    if (!errors) {
      fmt::print(stderr, "{}\n", errors.error().what);
      return 1;
    }
    print_row(std::filesystem::path(motion).filename().string(), *errors);
    all.add(*errors);
  }
  print_row("all motions", all);
  if (goals_file.empty()) return 0;
  return write_goals(goals_file, {{"the tracker's tips are off as far as on real captures",
                                   all.rms(&Squares::all), 26, "px", true}})
             ? 0
             : 1;
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  std::string rig = "config/rigs/twin.toml", goals;
  std::vector<std::string> settings;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--set" && i + 1 < argc) {
      settings.emplace_back(argv[++i]);
    } else if (word == "--goals" && i + 1 < argc) {
      goals = argv[++i];
    } else {
      rig = word;
    }
  }
  return handcast::bench::run(rig, settings, goals);
}
