// SPDX-License-Identifier: Apache-2.0
#include "renderer/estimate/known_errors.hpp"

#include <algorithm>

#include "ipc/base/clock.hpp"

namespace handcast::renderer {
namespace {

/// Between the estimates that are kept.
constexpr std::int64_t kApart_ns = 1'000'000'000;

}  // namespace

bool KnownErrors::Known::explain(const calib::CameraModel& camera, const Sighting& sighting) {
  if (time_ns != 0)
    errors.pass(ns_to_seconds(sighting.origin_ns - time_ns), flexions_of(sighting.reported),
                sighting.rest);
  time_ns = sighting.origin_ns;
  errors.unbend(sighting.abrupt.snapped_rad);
  return errors.update(camera, sighting.reported, sighting.seen, sighting.abrupt.landmarks);
}

bool KnownErrors::add(const calib::CameraModel& camera, const Sighting& sighting) {
  // Earlier estimates, and one that is forgotten, are not of the tracker before this change.
  Sighting unchanged = sighting;
  unchanged.abrupt.snapped_rad = {};
  if (2 * std::ranges::count(sighting.abrupt.landmarks, Abrupt::tracker) > kLandmarks)
    rivals_ = earlier_.size();
  if (now_.explain(camera, sighting)) {
    if (rivals_ > 0) compare(camera, unchanged);
  } else if (!recall(camera, unchanged)) {
    if (!is_doubtful_ || next_ != 0) return false;
    now_.errors.forget_place();
    if (!now_.explain(camera, unchanged)) return false;
  }
  is_doubtful_ = false;
  next_ = 0;
  if (now_.time_ns - earlier_[0].time_ns > kApart_ns) remember();
  return true;
}

/// Tries the next earlier estimate. One for each sighting, because each takes as long as an update.
bool KnownErrors::recall(const calib::CameraModel& camera, const Sighting& sighting) {
  const Known& known = earlier_[next_];
  next_ = (next_ + 1) % earlier_.size();
  if (known.time_ns == 0) return false;
  trial_ = known;
  if (!trial_.explain(camera, sighting)) return false;
  std::swap(now_, trial_);
  return true;
}

/// Compares the estimate with the next earlier one, if the tracker has moved most of the hand
/// abruptly. Of two that explain a hand, the one with much smaller errors is right.
void KnownErrors::compare(const calib::CameraModel& camera, const Sighting& sighting) {
  constexpr double kMuch = 0.25;
  const Known& known = earlier_[--rivals_];
  if (known.time_ns == 0) return;
  trial_ = known;
  if (trial_.explain(camera, sighting) && trial_.errors.surprise() < kMuch * now_.errors.surprise())
    std::swap(now_, trial_);
}

void KnownErrors::remember() {
  std::rotate(earlier_.begin(), earlier_.end() - 1, earlier_.end());
  earlier_[0] = now_;
}

HandErrors KnownErrors::errors_at(std::int64_t time_ns) const {
  return now_.errors.errors_after(std::max(0.0, ns_to_seconds(time_ns - now_.time_ns)));
}

}  // namespace handcast::renderer
