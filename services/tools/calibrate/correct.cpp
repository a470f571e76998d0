// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/correct.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "calib/drift/correction.hpp"
#include "ipc/client/stream.hpp"
#include "services/pose/drift/calibration_watch.hpp"
#include "services/tools/calibrate/desk.hpp"
#include "services/tools/calibrate/kept_file.hpp"

namespace handcast::calibrate {
namespace {

using namespace std::chrono_literals;

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
  keep_above({rig.calibration, config::measured_file_of(options.rig_file)});
  const auto written = write_and_keep(rig.calibration, calib::print_calibration(corrected));
  if (!written) return tl::make_unexpected(written.error());
  fmt::print("the calibration is in {}\n`handcast reload` applies it; --undo takes it back\n",
             *written);
  return {};
}

}  // namespace handcast::calibrate
