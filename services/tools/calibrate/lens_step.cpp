// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/lens_step.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <sstream>

#include "calib/solve/lens/auto_capture.hpp"
#include "calib/solve/lens/coverage.hpp"
#include "calib/solve/lens/lens_fit.hpp"
#include "ipc/base/input_file.hpp"
#include "ipc/base/write_whole.hpp"
#include "services/tools/calibrate/board_watch.hpp"
#include "services/tools/calibrate/steps.hpp"

namespace handcast::calibrate {
namespace {

std::filesystem::path file_of(const std::filesystem::path& folder, const std::string& step) {
  return folder / (step + ".covariance");
}

/// In the order of calib::kLensParameters.
std::array<double, 9> values_of(const calib::CameraModel& c) {
  return {c.fx_px, c.fy_px, c.cx_px, c.cy_px, c.k1, c.k2, c.p1, c.p2, c.k3};
}

constexpr std::size_t kEnoughViews = 15;
/// What a good fit stays below: the error of what it has not seen, and that of the focal length.
/// @{
constexpr double kGood_px = 0.6;
constexpr double kGoodFocal = 0.01;
/// @}

/// One of the rig's cameras.
struct Ring {
  const char* step;
  const char* stream;
};
constexpr Ring kFirst{"lens", "camera.frames"}, kSecond{"lens2", "camera2.frames"};

/// The views of a board that a person has shown. `camera`: its size counts.
Result<std::vector<calib::BoardView>> take_views(Desk& desk, const Ring& ring,
                                                 const calib::CameraModel& camera) {
  auto frames = client::open_stream<msg::CameraFrame>(desk.rig.name, ring.stream);
  if (!frames) return tl::make_unexpected(frames.error());
  BoardWatch board(desk.options.board);
  calib::Coverage coverage(camera.width_px, camera.height_px);
  calib::AutoCapture capture(camera.width_px);
  std::vector<calib::BoardView> views;
  Progress progress(desk, ring.step);
  while ((coverage.share() < 1 || views.size() < kEnoughViews) && progress.goes_on()) {
    const double views_share = static_cast<double>(views.size()) / kEnoughViews;
    progress.show(std::min({0.99, coverage.share(), views_share}),
                  board.why_missing().empty()
                      ? lens_advice(views.size(), kEnoughViews, coverage.advice())
                      : board.why_missing());
    const auto frame = progress.latest(*frames);
    if (!frame) continue;
    auto seen = board.find(view_of(**frame));
    if (!seen || !capture.take((*frame)->header.origin_ns, *seen)) continue;
    coverage.add(*seen);
    views.push_back(std::move(*seen));
  }
  if (progress.result() && views.empty() && !board.why_missing().empty())
    return fail(Errc::bad_data, "the board was never seen: " + board.why_missing());
  return progress.result().map([&] { return std::move(views); });
}

std::vector<Picture> pictures_of(const calib::LensFit& fit,
                                 std::span<const calib::BoardView> views) {
  std::vector<glm::dvec2> dots;
  for (const auto& view : views)
    dots.insert(dots.end(), view.image_px.begin(), view.image_px.end());
  return {dots_picture(fit.camera.width_px, fit.camera.height_px, dots,
                       fmt::format("Where the board was seen: {} corners in {} images. Parts "
                                   "without dots are extrapolated.",
                                   dots.size(), views.size())),
          errors_picture(fit.views,
                         "How far the corners of each image are from where the lens has them.")};
}

Outcome outcome_of(const calib::LensFit& fit, std::span<const calib::BoardView> views,
                   calib::BoardKind kind) {
  Outcome outcome;
  const auto& focal = fit.spreads[0];
  const double focal_error = (focal.high - focal.low) / 2 / fit.camera.fx_px;
  outcome.made = fmt::format("{} images, {:.2f} px held out, focal length {:.1f} px +- {:.2f} %",
                             views.size(), fit.held_out_px, fit.camera.fx_px, 100 * focal_error);
  for (std::size_t i = 0; i < fit.views.size(); ++i)
    if (!fit.views[i].rejected.empty())
      outcome.findings.push_back(
          fmt::format("image {} was left out. {}", i + 1, fit.views[i].rejected));
  outcome.is_good = fit.held_out_px <= kGood_px && focal_error <= kGoodFocal;
  if (!outcome.is_good)
    outcome.findings.insert(outcome.findings.begin(),
                            "this lens is not well known yet: is the board flat, and was it held "
                            "near and far, in all corners, and tilted?");
  outcome.meaning = fmt::format(
      "Held out: how far corners are from where a fit that has not seen their image expects them; "
      "good is at most {} px. +-: with 95 % probability the focal length is within; good is at "
      "most {:g} %",
      kGood_px, 100 * kGoodFocal);
  if (kind != calib::BoardKind::charuco)
    outcome.meaning +=
        ". This board looks the same in a mirror: if a half mirror or the camera mirrors the "
        "image, "
        "only a charuco board shows it";
  outcome.pictures = pictures_of(fit, views);
  return outcome;
}

/// Measures one camera from a board that a person shows, and sets its lens. Ends when enough was
/// seen, Enter is pressed or the time is over. Errors: those of calib::fit_lens() and of
/// client::Stream.
Result<Outcome> measure(Desk& desk, const Ring& ring, calib::CameraModel& camera) {
  const auto views = take_views(desk, ring, camera);
  if (!views) return tl::make_unexpected(views.error());
  const auto fit = calib::fit_lens(*views, camera.width_px, camera.height_px);
  if (!fit) return tl::make_unexpected(fit.error());
  camera = fit->camera;
  auto outcome = outcome_of(*fit, *views, desk.options.board.kind);
  if (!outcome.is_good) return outcome;
  return remember_lens(desk.options.folder, ring.step, *fit).map([&] { return outcome; });
}

Result<Outcome> measure_first(Desk& desk) { return measure(desk, kFirst, desk.draft.camera); }

Result<Outcome> measure_second(Desk& desk) {
  if (!desk.draft.camera2) return fail(Errc::bad_config, "the rig has no second camera");
  return measure(desk, kSecond, desk.draft.camera2->camera);
}

std::vector<std::string> scene(const Options& options, double /*camera_hz*/) {
  return board_scene(options, 1);
}

std::vector<std::string> second_scene(const Options& options, double /*camera_hz*/) {
  auto settings = board_scene(options, 1);
  settings.emplace_back("twin.prop.views=second");
  return settings;
}

const char* instruct(const Options& /*options*/) {
  return "Hold the printed board in front of the camera, still for a moment at each place: in the "
         "middle and in every corner of the image, near and far, tilted to all sides.";
}

const char* instruct_second(const Options& /*options*/) {
  return "The same with the second camera: hold the board in the middle and in every corner of its "
         "image, near and far, tilted to all sides.";
}

}  // namespace

const StepEntry kLensStep{.step = Step::lens,
                          .made = &calib::Made::lens,
                          .scene = scene,
                          .instruct = instruct,
                          .measure = measure_first};
const StepEntry kSecondLensStep{.step = Step::lens2,
                                .made = &calib::Made::lens2,
                                .scene = second_scene,
                                .instruct = instruct_second,
                                .measure = measure_second};

std::string lens_advice(std::size_t views, std::size_t wanted, const std::string& place) {
  if (views == 0) return "Hold the board still in front of the camera";
  if (place.empty())
    return views + 1 >= wanted
               ? "Almost done: one more image, at another place"
               : fmt::format("All places were seen: {} more images, tilted and at other places",
                             wanted - views);
  return views >= wanted ? "Almost done: " + place : place;
}

Result<void> remember_lens(const std::filesystem::path& folder, const std::string& step,
                           const calib::LensFit& fit) {
  std::string text;
  for (const double value : values_of(fit.camera)) text += fmt::format("{} ", value);
  text += "\n";
  for (const auto& row : fit.covariance) {
    for (const double value : row) text += fmt::format("{} ", value);
    text += "\n";
  }
  return write_whole(file_of(folder, step), text);
}

std::optional<calib::LensCovariance> recall_lens(const std::filesystem::path& folder,
                                                 const std::string& step,
                                                 const calib::CameraModel& camera) {
  constexpr double kSame = 1e-6;  // a draft is text
  const auto text = read_input(file_of(folder, step), kMostText);
  if (!text) return {};
  std::istringstream file(*text);
  for (const double wanted : values_of(camera)) {
    double value = 0;
    if (!(file >> value) || std::abs(value - wanted) > kSame * (1 + std::abs(wanted))) return {};
  }
  calib::LensCovariance covariance{};
  for (auto& row : covariance)
    for (double& value : row)
      if (!(file >> value)) return {};
  return covariance;
}

}  // namespace handcast::calibrate
