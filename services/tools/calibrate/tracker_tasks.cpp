// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/tracker_tasks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "calib/drift/correction.hpp"
#include "config/measured.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/number_text.hpp"
#include "ipc/client/stream.hpp"
#include "services/pose/drift/calibration_watch.hpp"
#include "services/recording/arrays/npy.hpp"
#include "services/tools/calibrate/desk.hpp"
#include "services/tools/calibrate/kept_file.hpp"

namespace handcast::calibrate {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

/// An array of n rows of `columns` numbers.
Result<recording::Npy> read_rows(const fs::path& file, std::size_t columns) {
  auto array = recording::read_npy(file);
  if (!array) return array;
  const auto& shape = array->shape;
  const bool fits = columns == 1 ? shape.size() == 1 : shape.size() == 2 && shape[1] == columns;
  if (fits) return array;
  return fail(Errc::bad_data, fmt::format("{}: the array must have n rows of {} {}", file.string(),
                                          columns, columns == 1 ? "number" : "numbers"));
}

/// The times of the points, since the first.
Result<std::vector<std::int64_t>> times_of(const fs::path& folder, std::size_t count) {
  std::vector<std::int64_t> times_ns;
  const auto file = folder / "timestamps.npy";
  std::error_code unknown;
  const bool has_times = fs::exists(file, unknown);
  if (unknown)
    return fail(Errc::bad_config, fmt::format("{}: {}", file.string(), unknown.message()));
  if (!has_times) {
    for (std::size_t i = 0; i < count; ++i)
      times_ns.push_back(seconds_to_ns(static_cast<double>(i) / kPoints_hz));
    return times_ns;
  }
  const auto times_us = read_rows(file, 1);
  if (!times_us) return tl::make_unexpected(times_us.error());
  if (times_us->values.size() != count)
    return fail(Errc::bad_data, fmt::format("{}: there are {} times of {} points", file.string(),
                                            times_us->values.size(), count));
  constexpr double kMost_us = 2 * 3600e6;
  for (const double time_us : times_us->values) {
    const double since_us = time_us - times_us->values.front();
    if (!(std::abs(since_us) < kMost_us))
      return fail(
          Errc::bad_data,
          fmt::format("{}: the times are not within two hours of each other", file.string()));
    times_ns.push_back(static_cast<std::int64_t>(since_us * 1e3));
  }
  return times_ns;
}

std::string_view word_of(calib::Quality quality) {
  switch (quality) {
    case calib::Quality::good:
      return "good";
    case calib::Quality::usable:
      return "usable";
    case calib::Quality::poor:
      return "poor";
  }
  return "poor";
}

/// With so many places a drift is known, and after more it becomes no better.
constexpr int kEnough = 12, kMost = 30;
constexpr std::int64_t kPrintEvery_ns = 1'000'000'000;

std::string describe(const calib::Drift& drift) {
  return fmt::format("{:.1f} mm +- {:.1f} across the camera's axis, {:.2f} degrees +- {:.2f}",
                     drift.across_mm, 2 * drift.across_sd_mm, drift.turn_deg,
                     2 * drift.turn_sd_deg);
}

bool is_known(const calib::Drift& drift) {
  return drift.places >= kMost || (drift.places >= kEnough && drift.moved);
}

bool pressed_enter(Keys& keys) {
  bool is_pressed = false;
  while (const auto key = keys.pressed()) is_pressed = is_pressed || key->character == '\n';
  return is_pressed;
}

/// What a rig that is up says of hands.
struct Streams {
  client::Stream<msg::HandPoses> poses;
  client::Stream<msg::Landmarks> landmarks;
};

Result<Streams> open_streams(const config::Rig& rig) {
  auto poses = client::open_stream<msg::HandPoses>(rig.name, "pose.hands");
  if (!poses) return tl::make_unexpected(poses.error());
  auto landmarks = client::open_stream<msg::Landmarks>(rig.name, "landmarks.hands");
  if (!landmarks) return tl::make_unexpected(landmarks.error());
  return Streams{std::move(*poses), std::move(*landmarks)};
}

/// Watches hands until the drift is known, Enter is pressed or the time is over.
Result<calib::Drift> watch(const Options& options, const config::Rig& rig,
                           const calib::Calibration& used, Streams& streams, Keys& keys) {
  auto settings = rig.pose.drift;
  settings.watch = config::DriftWatch::always;
  pose::CalibrationWatch watch(settings, used);
  const auto end = Deadline::in(std::chrono::nanoseconds(seconds_to_ns(options.most_s)));
  std::int64_t printed_ns = 0;
  while (!is_known(watch.drift()) && !end.passed() && !pressed_enter(keys)) {
    if (auto on = not_stopped(); !on) return tl::make_unexpected(on.error());
    const auto seen = streams.landmarks.next(Deadline::in(200ms));
    if (seen) watch.see(**seen);
    if (!seen && seen.error().code != Errc::timeout) return tl::make_unexpected(seen.error());
    while (const auto sample = streams.poses.next(Deadline::now())) watch.see(**sample);
    if (now_ns() - printed_ns < kPrintEvery_ns) continue;
    printed_ns = now_ns();
    fmt::print(stderr, "  {} of {} places: {}\n", watch.drift().places, kEnough,
               describe(watch.drift()));
  }
  return watch.drift();
}

Result<void> check_file(const config::Rig& rig) {
  if (!rig.calibration.empty()) return {};
  return fail(Errc::bad_config,
              "the rig names no calibration file; measure one with `handcast calibrate RIG.toml`");
}

}  // namespace

Result<RecordedPoints> read_points(const fs::path& folder, const calib::CameraModel& camera) {
  const auto px = read_rows(folder / "2dpoints.npy", 2);
  if (!px) return tl::make_unexpected(px.error());
  const auto mm = read_rows(folder / "3dpoints.npy", 3);
  if (!mm) return tl::make_unexpected(mm.error());
  const auto count = px->shape[0];
  if (mm->shape[0] != count)
    return fail(Errc::bad_data,
                fmt::format("{}: there are {} points in the image and {} in space; they must be "
                            "the same points",
                            folder.string(), count, mm->shape[0]));
  const auto times_ns = times_of(folder, count);
  if (!times_ns) return tl::make_unexpected(times_ns.error());
  RecordedPoints points;
  for (std::size_t i = 0; i < count; ++i) {
    const auto* at = &mm->values[3 * i];
    points.samples.push_back({(*times_ns)[i], {glm::dvec3(at[0], at[1], at[2]) * 1e-3}});
    const glm::dvec2 seen(px->values[2 * i], px->values[2 * i + 1]);
    points.sightings.push_back({(*times_ns)[i], 0, camera.undistort(seen), 1});
  }
  return points;
}

std::vector<std::string> describe_points(const calib::TrackerFit& fit) {
  const auto place_mm = 1e3 * glm::dvec3(glm::inverse(fit.camera_from_tracker)[3]);
  const auto& spread = fit.camera_place_mm;
  const auto& turn = fit.rotation_deg;
  std::vector<std::string> lines{
      fmt::format("These points are {}: {:.0f} % of them fit, within {:.1f} px (median); held out "
                  "{:.1f} px.",
                  word_of(fit.quality), 100 * fit.inlier_share, fit.inliers.median_px,
                  fit.held_out.median_px),
      fmt::format("They allow a camera at ({}, {}, {}) mm of the tracker, +-{:.1f} mm "
                  "to the right, +-{:.1f} mm down and +-{:.1f} mm forward (95 %).",
                  number_text(place_mm.x, 1), number_text(place_mm.y, 1),
                  number_text(place_mm.z, 1), spread[0].high, spread[1].high, spread[2].high),
      fmt::format("Its rotation is known to +-{:.2f}, +-{:.2f} and +-{:.2f} degrees, the offset of "
                  "the clocks ({} ms) to +-{:.1f} ms.",
                  turn[0].high, turn[1].high, turn[2].high,
                  signed_text(ns_to_ms(fit.clock_offset_ns), 1), fit.clock_offset_ms.high)};
  lines.insert(lines.end(), fit.findings.begin(), fit.findings.end());
  return lines;
}

Result<void> judge_points(const fs::path& folder, const calib::CameraModel& camera) {
  const auto points = read_points(folder, camera);
  if (!points) return tl::make_unexpected(points.error());
  const auto fit = calib::fit_tracker(camera, points->samples, points->sightings);
  if (!fit) return tl::make_unexpected(fit.error());
  for (const auto& line : describe_points(*fit)) fmt::print("{}\n", line);
  if (fit->quality != calib::Quality::poor) return {};
  return fail(Errc::bad_data, "these points are too poor for a calibration");
}

Result<void> correct_tracker(const Options& options, const config::Rig& rig,
                             const calib::Calibration& used) {
  if (auto has_file = check_file(rig); !has_file) return has_file;
  auto streams = open_streams(rig);
  if (!streams) return fail_in("--correct watches hands of a rig that is up", streams.error());
  fmt::print(stderr,
             "Hold an open hand still for a second; then at another place, turned otherwise, and "
             "so on, everywhere in the volume. Enter ends it.\n");
  Keys keys;
  const auto drift = watch(options, rig, used, *streams, keys);
  if (!drift) return tl::make_unexpected(drift.error());
  auto corrected = used;
  const auto place = calib::corrected(used, *drift);
  if (!place) return tl::make_unexpected(place.error());
  corrected.camera_from_tracker = *place;
  fmt::print(stderr, "the tracker has moved by {}\n", describe(*drift));
  const auto wanted =
      options.yes ? Result<bool>(true)
                  : keys.confirm("Enter corrects the calibration by this; s leaves it as it is");
  if (!wanted) return tl::make_unexpected(wanted.error());
  if (!*wanted) return {};
  corrected.made.tracker += fmt::format("; {}: corrected by {:.1f} mm and {:.2f} degrees",
                                        local_time("%Y-%m-%d"), drift->across_mm, drift->turn_deg);
  const auto written = write_and_keep(rig.calibration, calib::print_calibration(corrected),
                                      newest_number({rig.calibration, rig.projector2.calibration,
                                                     config::measured_file_of(options.rig_file)}));
  if (!written) return tl::make_unexpected(written.error());
  fmt::print("the calibration is in {}\n`handcast reload` applies it; --undo takes it back\n",
             *written);
  return {};
}

}  // namespace handcast::calibrate
