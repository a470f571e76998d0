// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "config/settings/choice.hpp"
#include "ipc/base/log.hpp"
#include "services/tools/calibrate/check_steps.hpp"
#include "services/tools/calibrate/lens_step.hpp"
#include "services/tools/calibrate/light_step.hpp"
#include "services/tools/calibrate/pair_step.hpp"
#include "services/tools/calibrate/screen_step.hpp"
#include "services/tools/calibrate/tracker_step.hpp"

namespace handcast::calibrate {
namespace {

constexpr std::array kSteps{
    StepEntry{Step::lens, measure_lens,
              "Hold the printed board in front of the camera, still for a moment at each place: in "
              "the middle and in every corner of the image, near and far, tilted to all sides."},
    StepEntry{
        Step::lens2, measure_second_lens,
        "The same with the second camera: hold the board in the middle and in every corner of "
        "its image, near and far, tilted to all sides."},
    StepEntry{Step::pair, measure_pair,
              "Hold the board where both cameras see all of it, still for a moment at each place: "
              "near and far, left and right, tilted to all sides."},
    StepEntry{Step::screen, measure_screen,
              "Hold or stand the board in the projector's light, still until it asks for the next "
              "place: at three or more distances."},
    StepEntry{Step::tracker, measure_tracker,
              "Take the board away. Move an open hand slowly through the whole volume in which the "
              "show takes place, nearer and farther, too."},
    StepEntry{Step::light, measure_light,
              "Hold one open hand still in the middle of the camera's view, for ten seconds. The "
              "projector lights it white and dark in turns."},
};

constexpr const char* kReflectorInstruction =
    "Take the board away, and put the reflector on the very tip of an index finger. Expose so "
    "briefly that only the reflector is white. Move the stretched finger through the whole volume "
    "in which the show takes place, nearer and farther, too, and turn the hand.";

Result<OwnRig> rig_of(const Options& options, const std::string& name,
                      const std::vector<std::string>& settings, const std::filesystem::path& log,
                      bool is_up) {
  if (is_up) return OwnRig::beside(name);
  fmt::print(stderr, "  the rig starts\n");
  return OwnRig::start(options.rig_file, name, settings, log);
}

void print_outcome(const Outcome& outcome) {
  fmt::print(stderr, "  {}\n", printable(outcome.made));
  for (const auto& finding : outcome.findings) fmt::print(stderr, "  - {}\n", printable(finding));
}

}  // namespace

const StepEntry& entry_of(Step step) { return *std::ranges::find(kSteps, step, &StepEntry::step); }

std::vector<Step> steps_of(const Options& options, const config::Rig& rig, const Session& session) {
  std::vector<Step> steps = options.steps;
  if (!steps.empty()) return steps;
  for (const auto& entry : kSteps)
    if (has_need_of(rig, entry.step) && !session.is_done(entry.step)) steps.push_back(entry.step);
  return steps;
}

Result<bool> is_wanted(const Options& options, Keys& keys, const StepEntry& entry) {
  const bool by_reflector = entry.step == Step::tracker && options.reflector_mm > 0;
  fmt::print(stderr, "\n{}\n  {}\n", config::word_of(entry.step),
             by_reflector ? kReflectorInstruction : entry.instruction);
  if (options.yes || !keys.has_person()) return true;
  fmt::print(stderr, "  Enter begins, and ends the step early; s leaves it out\n");
  for (;;) {
    if (auto on = not_stopped(); !on) return tl::make_unexpected(on.error());
    if (const auto key = keys.pressed()) {
      if (key->character == '\n') return true;
      if (key->character == 's') return false;
    }
    sleep_until_ns(now_ns() + 20'000'000);
  }
}

Result<Outcome> with_rig(const Options& options, const RunningAs& running,
                         const std::filesystem::path& logs, calib::Calibration& draft, Keys& keys,
                         const StepEntry& entry, bool is_up) {
  const auto rig = config::load_rig(options.rig_file, options.settings);
  if (!rig) return tl::make_unexpected(rig.error());
  std::vector<std::string> settings;
  if (rig->camera.backend == "twin" && !is_up)
    settings = twin_scene(entry.step, options, rig->camera.rate_hz);
  // What the person sets comes later, and wins.
  settings.insert(settings.end(), running.settings.begin(), running.settings.end());
  const auto as_it_runs = config::load_rig(options.rig_file, settings);
  if (!as_it_runs) return tl::make_unexpected(as_it_runs.error());
  auto own_rig = rig_of(options, rig->name, settings,
                        logs / fmt::format("{}.log", config::word_of(entry.step)), is_up);
  if (!own_rig) return tl::make_unexpected(own_rig.error());
  auto screen = TestScreen::open(rig->name, running.calibration.projector_width_px,
                                 running.calibration.projector_height_px);
  if (!screen) return tl::make_unexpected(screen.error());
  Desk desk{options, *as_it_runs, running.calibration, draft, *own_rig, *screen, keys};
  auto outcome = entry.measure(desk);
  if (outcome) print_outcome(*outcome);
  return outcome;
}

}  // namespace handcast::calibrate
