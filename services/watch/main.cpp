// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration.hpp"
#include "config/settings/frozen_file.hpp"
#include "services/runtime/context.hpp"
#include "services/runtime/scheduling.hpp"
#include "services/watch/night_watch.hpp"

using namespace handcast;
using namespace std::chrono_literals;
using service::must;

/// The text of the rig's calibration file; empty if it cannot be read.
static std::string calibration_of(const config::Rig& rig) {
  if (rig.calibration.empty()) return calib::print_calibration(calib::reference_rig());
  const auto file = config::read_file_or_frozen(rig.calibration);
  return file ? file->text : "";
}

/// At low priority: where cores are short, the watch is late rather than the light.
static void run_watch(service::Context& context) {
  service::give_way();
  const auto& rig = context.filed();
  context.stand_by();
  watch::Lights lights(must(config::LiveBoard::open(rig.name)));
  const auto night_watch = must(watch::NightWatch::open(
      {.settings = rig,
       .calibration = calibration_of(rig),
       .started_ns = context.epoch_ns(),
       .ring = [&](std::string_view stream) { return context.ring(stream); }},
      std::move(lights), watch::Moment::now()));
  context.ready();
  while (context.running()) {
    night_watch->turn(watch::Moment::now());
    sleep_until_ns(now_ns() + to_ns(50ms));
  }
  night_watch->stop(watch::Moment::now());
}

int main(int argc, char** argv) {
  return service::run({.name = "watch",
                       .summary = "Looks after the rig: opening hours, reports, alerts.",
                       .paced_by = "20 Hz",
                       .subscribes = {"pose.hands", "landmarks.hands", "landmarks2.hands"},
                       .settings = {"watch", "projector.lamp"}},
                      argc, argv, run_watch);
}
