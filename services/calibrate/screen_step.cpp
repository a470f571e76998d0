// SPDX-License-Identifier: Apache-2.0
#include "services/calibrate/screen_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "calib/board/board_finder.hpp"
#include "calib/lens/auto_capture.hpp"
#include "calib/lens/board_pose.hpp"
#include "calib/screen/depth_error.hpp"
#include "calib/screen/gray_code.hpp"
#include "calib/screen/screen_fit.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "services/calibrate/by_hand.hpp"
#include "services/calibrate/image_fields.hpp"
#include "services/calibrate/pattern_images.hpp"
#include "services/calibrate/pieces.hpp"

namespace handcast::calibrate {
namespace {

using namespace std::chrono_literals;

constexpr int kWantedViews = 5;
constexpr double kGood_px = 1;   ///< error of what a good fit has not seen, median
constexpr double kMoved_px = 1;  ///< by which the board may have moved during the patterns

/// One measurement of the projector.
class ScreenMeasurement {
 public:
  ScreenMeasurement(Desk& desk, client::Stream<msg::CameraFrame> frames, PatternImages patterns)
      : desk_(desk),
        frames_(std::move(frames)),
        patterns_(std::move(patterns)),
        finder_(desk.options.board),
        code_(desk.screen.width_px(), desk.screen.height_px()),
        capture_(desk.used.camera.width_px),
        seen_(desk.used.camera.width_px, desk.used.camera.height_px) {}

  Result<std::vector<calib::DepthView>> take_views() {
    std::vector<calib::DepthView> views;
    Progress progress(desk_, "screen");
    std::string advice = "Hold the board still in the light";
    while (static_cast<int>(views.size()) < kWantedViews) {
      if (const auto on = progress.goes_on(); !on || !*on) {
        if (!on) return tl::make_unexpected(on.error());
        break;
      }
      progress.show(static_cast<double>(views.size()) / kWantedViews, advice);
      const auto ready = is_ready();
      if (!ready) return tl::make_unexpected(ready.error());
      if (!*ready) continue;
      auto view = measure();
      if (!view && view.error().code == Errc::bad_data) view = measure();
      if (!view && view.error().code != Errc::bad_data) return tl::make_unexpected(view.error());
      if (!view) {
        advice = view.error().what;
        continue;
      }
      for (const auto& point : view->points) seen_.add(point.camera_px);
      views.push_back(std::move(*view));
      advice = fmt::format(
          "Now hold it nearer or farther, tilted, and more to the {} of the camera's image",
          seen_.emptiest());
    }
    return views;
  }
  const ImageFields& seen() const { return seen_; }

 private:
  /// True if the next image has the board, still and at a new place.
  Result<bool> is_ready() {
    const auto frame = frames_.latest(Deadline::in(200ms));
    if (!frame && frame.error().code == Errc::timeout) return false;
    if (!frame) return tl::make_unexpected(frame.error());
    const auto width = static_cast<int>((*frame)->width_px);
    const auto board =
        finder_.find({(*frame)->pixels(), width, static_cast<int>((*frame)->height_px), width});
    return board && capture_.take((*frame)->header.origin_ns, *board);
  }

  /// Shows all patterns on the board, between two white ones in which it must be at the same place.
  /// Error bad_data: it is not, or the patterns could not be read.
  Result<calib::DepthView> measure() {
    std::vector<PatternImages::Image> images;
    for (int i = 0; i <= code_.patterns(); ++i) {
      const int pattern = i % code_.patterns();  // 0 is white
      auto image = patterns_.image([&](std::uint8_t* levels) { code_.draw(pattern, levels); });
      if (!image) return tl::make_unexpected(image.error());
      images.push_back(std::move(*image));
    }
    const auto& camera = desk_.draft.camera;
    const auto view_of = [&](const PatternImages::Image& image) {
      return calib::GreyView{image.data(), camera.width_px, camera.height_px, camera.width_px};
    };
    const auto before = finder_.find(view_of(images.front())),
               after = finder_.find(view_of(images.back()));
    if (!before || !after) return fail(Errc::bad_data, "The whole board must be in the light");
    if (!(largest_move_px(*before, *after) < kMoved_px))
      return fail(Errc::bad_data, "The board moved: hold it still");
    const auto pose = calib::board_pose(camera, *before);
    if (!pose) return fail(Errc::bad_data, "The board is not flat, or the lens is wrong");
    images.pop_back();
    darken_beside(*pose, images);
    std::vector<calib::GreyView> views;
    std::ranges::transform(images, std::back_inserter(views), view_of);
    auto decoded = code_.decode(views);
    if (!decoded) return tl::make_unexpected(decoded.error());
    const glm::dvec3 normal((*pose)[2]), origin((*pose)[3]);
    return calib::DepthView{std::move(decoded->points),
                            glm::dvec4(normal, -glm::dot(normal, origin))};
  }

  /// The largest move of a point that both views have; infinite if they share none.
  static double largest_move_px(const calib::BoardView& a, const calib::BoardView& b) {
    double largest = -1;
    for (std::size_t i = 0; i < a.ids.size(); ++i)
      for (std::size_t j = 0; j < b.ids.size(); ++j)
        if (a.ids[i] == b.ids[j])
          largest = std::max(largest, glm::distance(a.image_px[i], b.image_px[j]));
    return largest < 0 ? std::numeric_limits<double>::infinity() : largest;
  }

  /// Sets the pixels beside the board to 0 in all images: what is behind it is lit, too.
  void darken_beside(const glm::dmat4& camera_from_board,
                     std::vector<PatternImages::Image>& images) const {
    const auto& camera = desk_.draft.camera;
    const auto& board = desk_.options.board;
    const glm::dvec2 size_m(1e-3 * board.square_mm * board.columns,
                            1e-3 * board.square_mm * board.rows);
    // The homography from undistorted camera pixels to the board's plane, metres.
    const auto board_from_camera =
        glm::inverse(camera.matrix() * glm::dmat3(glm::dvec3(camera_from_board[0]),
                                                  glm::dvec3(camera_from_board[1]),
                                                  glm::dvec3(camera_from_board[3])));
    for (int y = 0; y < camera.height_px; ++y)
      for (int x = 0; x < camera.width_px; ++x) {
        const auto at = board_from_camera * glm::dvec3(camera.undistort({x, y}), 1);
        const glm::dvec2 at_m = glm::dvec2(at) / at.z;
        if (glm::all(glm::greaterThan(at_m, glm::dvec2(0))) &&
            glm::all(glm::lessThan(at_m, size_m)))
          continue;
        const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width_px) +
                       static_cast<std::size_t>(x);
        for (auto& image : images) image[i] = 0;
      }
  }

  Desk& desk_;
  client::Stream<msg::CameraFrame> frames_;
  PatternImages patterns_;
  calib::BoardFinder finder_;
  calib::GrayCode code_;
  calib::AutoCapture capture_;
  ImageFields seen_;
};

double mean_depth_m(std::span<const calib::DepthView> views) {
  double sum = 0;
  for (const auto& view : views) sum += -view.plane.w / view.plane.z;  // on the camera's axis
  return sum / static_cast<double>(views.size());
}

std::string place_of(const calib::ScreenFit& fit) {
  if (fit.coaxial) return "coaxial";
  if (!fit.baseline) return "not coaxial";
  return fmt::format("the projector is {:.0f} mm from the camera, +- {:.0f}",
                     fit.baseline->length_mm, fit.baseline->interval_mm);
}

/// Where the light was measured, and what one homography would miss.
std::string pictures_of(const Desk& desk, std::span<const calib::DepthView> views,
                        const calib::ScreenFit& fit) {
  std::vector<glm::dvec2> dots_px;
  for (const auto& view : views)
    for (const auto& point : view.points) dots_px.push_back(point.camera_px);
  const auto& camera = desk.draft.camera;
  auto html =
      dots_svg(camera.width_px, camera.height_px, dots_px,
               "Where the projector's light was measured; elsewhere the model is extrapolated.");
  if (fit.coaxial) return html;
  const std::array depths_m{fit.depths_m[0], fit.model.plane_m, fit.depths_m[1]};
  return html + errors_svg(calib::coaxial_error(fit.model, camera, depths_m),
                           "By how many projector pixels one homography for all depths would miss. "
                           "The calibration has the parallax, and does not.");
}

std::string delay_finding(const Desk& desk, const calib::LightDelay& delay) {
  const double latency_ms = desk.rig.projector.latency_ms + delay.delay_ms;
  return fmt::format(
      "the light comes {:.1f} ms ({:.1f} to {:.1f}) later than the projector reports: set "
      "projector.latency_ms = {:.1f}",
      delay.delay_ms, delay.low_ms, delay.high_ms, latency_ms);
}

}  // namespace

Result<Outcome> measure_screen(Desk& desk) {
  auto patterns = PatternImages::open(desk);
  if (!patterns) return tl::make_unexpected(patterns.error());
  fmt::print(stderr, "  measuring the delay of the light\n");
  const auto delay = patterns->measure_delay();
  if (!delay && delay.error().code == Errc::bad_data) {
    fmt::print(stderr, "  {}\n", delay.error().what);
    return align_by_hand(desk);
  }
  if (!delay) return tl::make_unexpected(delay.error());
  auto frames = client::open_stream<msg::CameraFrame>(desk.rig.name, "camera.frames");
  if (!frames) return tl::make_unexpected(frames.error());
  ScreenMeasurement measurement(desk, std::move(*frames), std::move(*patterns));
  const auto views = measurement.take_views();
  if (!views) return tl::make_unexpected(views.error());
  if (views->empty())
    return fail(Errc::bad_data, "the board was never still in the projector's light");
  const auto fit = calib::fit_screen(*views, desk.draft.camera, mean_depth_m(*views),
                                     {desk.screen.width_px(), desk.screen.height_px()});
  if (!fit) return tl::make_unexpected(fit.error());
  desk.draft.projector_from_camera = fit->model.projector_from_camera;
  desk.draft.parallax = fit->model.parallax;
  desk.draft.plane_m = fit->model.plane_m;
  const double held_out_px =
      fit->coaxial ? fit->held_out_coaxial.median : fit->held_out_full.median;
  Outcome outcome{fmt::format("{} places of the board, {:.2f} px held out, {}", views->size(),
                              held_out_px, place_of(*fit)),
                  held_out_px <= kGood_px, fit->findings, pictures_of(desk, *views, *fit)};
  if (const auto empty = measurement.seen().empty(); !empty.empty())
    outcome.findings.push_back("no light was measured in these parts of the camera's image: " +
                               empty + "; there the model is extrapolated");
  if (delay->low_ms > 1 || delay->high_ms < -1)
    outcome.findings.push_back(delay_finding(desk, *delay));
  return outcome;
}

}  // namespace handcast::calibrate
