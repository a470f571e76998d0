// SPDX-License-Identifier: Apache-2.0
#include "services/calibrate/check_steps.hpp"

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

}  // namespace

bool has_need_of(const config::Rig& rig, Step step) {
  if (step == Step::lens2 || step == Step::pair) return config::has_second_view(rig);
  return step != Step::tracker || (rig.pose.backend != "none" && rig.pose.backend != "stereo");
}

Result<void> check_steps(const Options& options, const config::Rig& rig) {
  if (options.correct && !has_need_of(rig, Step::tracker)) return no_tracker("--correct", rig);
  const auto missing =
      std::ranges::find_if(options.steps, [&](Step step) { return !has_need_of(rig, step); });
  if (missing == options.steps.end()) return {};
  const auto word = config::word_of(*missing);
  if (*missing == Step::tracker) return no_tracker(word, rig);
  return fail(Errc::bad_config,
              fmt::format("{}: the rig has no second camera; set camera2.backend", word));
}

}  // namespace handcast::calibrate
