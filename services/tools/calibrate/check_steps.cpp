// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/check_steps.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/second_view.hpp"
#include "config/settings/choice.hpp"

namespace handcast::calibrate {
namespace {

Result<void> no_tracker(std::string_view asked, const config::Rig& rig) {
  const auto* why = rig.pose.backend == "none"
                        ? "the rig has no poses (pose.backend is none), so there is no tracker to "
                          "measure"
                        : "the poses of this rig come from its cameras, so there is no tracker to "
                          "measure; if a camera has moved, measure `pair` (and `screen`) again";
  return fail(Errc::bad_config, fmt::format("{}: {}", asked, why));
}

Result<void> no_second_camera(std::string_view asked) {
  return fail(Errc::bad_config,
              fmt::format("{}: the rig has no second camera; set camera2.backend", asked));
}

}  // namespace

const char* what_compares(const Options& options) {
  return options.check             ? "--check"
         : options.correct         ? "--correct"
         : !options.points.empty() ? "--points"
                                   : nullptr;
}

bool has_need_of(const config::Rig& rig, Step step) {
  if (step == Step::lens2 || step == Step::pair) return config::has_second_view(rig);
  return step != Step::tracker || (rig.pose.backend != "none" && rig.pose.backend != "stereo");
}

Result<void> check_steps(const Options& options, const config::Rig& rig) {
  if (const auto* asked = what_compares(options);
      asked && rig.calibration.empty() && rig.camera.backend != "twin")
    return fail(Errc::bad_config,
                fmt::format("{} needs a calibration, and the rig names none; measure one first: "
                            "handcast calibrate {}",
                            asked, options.rig_file.string()));
  const bool has_tracker = has_need_of(rig, Step::tracker);
  if (options.correct && !has_tracker) return no_tracker("--correct", rig);
  if (options.reflector_mm > 0 && !has_tracker) return no_tracker("--reflector", rig);
  if (options.camera2.width_px > 0 && !has_need_of(rig, Step::pair))
    return no_second_camera("--camera2");
  const auto missing =
      std::ranges::find_if(options.steps, [&](Step step) { return !has_need_of(rig, step); });
  if (missing == options.steps.end()) return {};
  const auto word = config::word_of(*missing);
  if (*missing == Step::tracker) return no_tracker(word, rig);
  return no_second_camera(word);
}

}  // namespace handcast::calibrate
