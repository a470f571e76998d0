// SPDX-License-Identifier: Apache-2.0
// How accurately calib/solve/screen finds the pixels of the projector, on rendered and on synthetic
// boards (tests/calib/solve/screen/rendered_board.hpp), and how long it takes on one core.
//   bench_calib_screen [--goals FILE]
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "calib/solve/screen/depth_error.hpp"
#include "calib/solve/screen/resampling.hpp"
#include "tests/bench/goals.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/calib/solve/screen/rendered_board.hpp"

namespace handcast::bench {
namespace {

using calib::DepthView, calib::ProjectorModel, calib::test::kPlane_m;

const calib::CameraModel kCamera = calib::test::bent_camera();
const ProjectorModel kCoaxial = calib::test::coaxial_screen();
const ProjectorModel kBeside = calib::test::screen_beside(0.15);
const std::vector<double> kDepths_m{0.63, 0.73, 0.83};

template <class T>
T must(Result<T> result) {
  if (result) return *result;
  fmt::print(stderr, "bench_calib_screen: {}.\n", result.error().what);
  std::exit(1);
}

double worst_px(const ProjectorModel& believed, const ProjectorModel& truth) {
  return calib::test::worst_px(believed, truth, kCamera);
}

/// Times of the parts, ms.
struct Times {
  std::vector<double> decode_ms, homography_ms, screen_ms;
};

std::vector<DepthView> rendered_views(const ProjectorModel& screen, Times& times) {
  const calib::GrayCode code(calib::test::kProjectorWidth_px, calib::test::kProjectorHeight_px);
  std::vector<DepthView> views;
  for (const double depth_m : kDepths_m) {
    const auto plane = calib::test::tilted_board(depth_m);
    calib::test::RenderedBoard board(screen, plane);
    const auto shots = calib::test::shoot(code, board);
    calib::GrayDecoding decoded;
    times.decode_ms.push_back(timed_us([&] { decoded = must(code.decode(shots.views())); }) / 1000);
    views.push_back({decoded.points, plane});
  }
  return views;
}

/// Through the camera's images.
void measure_rendered(std::vector<Goal>& goals, Times& times) {
  const auto coaxial = rendered_views(kCoaxial, times), beside = rendered_views(kBeside, times);
  calib::HomographyFit one;
  times.homography_ms.push_back(
      timed_us([&] { one = must(calib::fit_homography(coaxial[1].points, kCamera)); }) / 1000);
  calib::ScreenFit three, full;
  times.screen_ms.push_back(
      timed_us([&] { three = must(calib::fit_screen(coaxial, kCamera, kPlane_m)); }) / 1000);
  times.screen_ms.push_back(
      timed_us([&] { full = must(calib::fit_screen(beside, kCamera, kPlane_m)); }) / 1000);
  goals.push_back({"coaxial, one board: largest error over +-100 mm",
                   worst_px({one.projector_from_camera, glm::dvec3(0), kPlane_m}, kCoaxial), 0.5,
                   "px"});
  goals.push_back({"coaxial, three boards: largest error over +-100 mm",
                   worst_px(three.model, kCoaxial), 0.5, "px"});
  goals.push_back({"150 mm beside, three boards: largest error over +-100 mm",
                   worst_px(full.model, kBeside), 0.5, "px"});
  goals.push_back({"150 mm beside: error of the baseline",
                   std::abs(full.baseline.value_or(calib::Baseline{}).length_mm - 150), 1, "mm"});
}

/// Boards whose poses are off by 1 mm along the camera's axis and 0.2 degrees (standard
/// deviations).
void measure_wrong_poses(std::vector<Goal>& goals) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 1);
  std::vector<double> worst;
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::vector<DepthView> views;
    for (double depth_m = 0.6; depth_m < 0.87; depth_m += 0.05) {
      const double tilt_rad = 0.3 * normal(random);
      views.push_back(
          {calib::test::seen_points(kCamera, kBeside, calib::test::tilted_board(depth_m, tilt_rad),
                                    0.2, seed),
           calib::test::tilted_board(depth_m + 0.001 * normal(random),
                                     tilt_rad + glm::radians(0.2) * normal(random))});
    }
    worst.push_back(worst_px(must(calib::fit_screen(views, kCamera, kPlane_m)).model, kBeside));
  }
  goals.push_back(
      {"150 mm beside, six boards with wrong poses (1 mm, 0.2 degrees): largest error, "
       "median of 20 runs",
       median(worst), 1, "px"});
}

/// Shares of the intervals that hold the truth.
void measure_coverage(std::vector<Goal>& goals) {
  constexpr int kSeeds = 200;
  const auto truth = calib::corners_in_camera(kCoaxial, {1024, 768});
  int corners = 0, baselines = 0;
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    const auto plane = calib::test::tilted_board(kPlane_m);
    const auto fit = must(calib::fit_homography(
        calib::test::seen_points(kCamera, kCoaxial, plane, 0.5, seed), kCamera));
    for (std::size_t corner = 0; corner < 4; ++corner)
      for (int axis = 0; axis < 2; ++axis)
        corners += std::abs(fit.corners_px[corner][axis] - truth[corner][axis]) <=
                   fit.corner_interval_px[corner][axis];
    std::vector<DepthView> views;
    for (const double depth_m : kDepths_m) {
      const auto board = calib::test::tilted_board(depth_m);
      const auto number = static_cast<unsigned>(views.size());
      views.push_back(
          {calib::test::seen_points(kCamera, kBeside, board, 0.5, 3 * seed + number), board});
    }
    const auto baseline = must(calib::fit_screen(views, kCamera, kPlane_m)).baseline;
    baselines += baseline && std::abs(baseline->length_mm - 150) <= baseline->interval_mm;
  }
  goals.push_back({"95 % intervals of the corners hold the truth", corners / (8. * kSeeds), 0.9,
                   "of 200 x 8", true});
  goals.push_back({"95 % intervals of the baseline hold the truth",
                   static_cast<double>(baselines) / kSeeds, 0.9, "of 200", true});
}

std::vector<Goal> measure_goals() {
  std::vector<Goal> goals;
  Times times;
  measure_rendered(goals, times);
  measure_wrong_poses(goals);
  measure_coverage(goals);
  goals.push_back({"decoding of 38 images of 720 x 540", median(times.decode_ms), 500, "ms"});
  goals.push_back({"fit of a homography", median(times.homography_ms), 500, "ms"});
  goals.push_back({"fit of three boards", median(times.screen_ms), 2000, "ms"});
  return goals;
}

/// Not a goal: why the parallax is needed.
void print_coaxial_errors() {
  const ProjectorModel homography{kBeside.from_camera, glm::dvec3(0), kPlane_m};
  fmt::print("a coaxial homography for a projector 150 mm beside the camera:\n");
  for (const auto& error : calib::depth_error(
           homography, kBeside, kCamera, std::vector{0.63, 0.68, 0.72, 0.73, 0.74, 0.78, 0.83}))
    fmt::print("  at {:.2f} m: median {:.1f} px, at most {:.1f} px\n", error.depth_m,
               error.median_px, error.largest_px);
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  using namespace handcast::bench;
  const bool with_goals = argc == 3 && std::strcmp(argv[1], "--goals") == 0;
  if (argc != 1 && !with_goals) {
    fmt::print(stderr, "usage: bench_calib_screen [--goals FILE]\n");
    return 2;
  }
  print_coaxial_errors();
  const auto goals = measure_goals();
  print_goals(goals);
  if (!with_goals || write_goals(argv[2], goals)) return 0;
  fmt::print(stderr, "bench_calib_screen: cannot write '{}'.\n", argv[2]);
  return 1;
}
