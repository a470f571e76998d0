// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/motion.hpp"

#include <fmt/format.h>

#include "services/lab/twin/motions.hpp"

namespace handcast::twin {

Result<std::unique_ptr<Motion>> open_motion(const config::Twin& settings,
                                            const calib::Calibration& calibration) {
  constexpr std::string_view kBuiltin = "builtin:";
  if (settings.motion.starts_with(kBuiltin)) {
    const std::string name = settings.motion.substr(kBuiltin.size());
    auto motion = make_builtin_motion(name, settings, calibration);
    if (!motion)
      return fail(Errc::bad_config,
                  fmt::format("twin.motion: there is no built-in motion '{}'; choose one of {}",
                              name, builtin_motion_names()));
    return motion;
  }
  if (!std::filesystem::is_directory(settings.motion))
    return fail(
        Errc::bad_config,
        fmt::format("twin.motion: '{}' is not a folder; a built-in motion is builtin:NAME, with "
                    "NAME one of {}",
                    settings.motion, builtin_motion_names()));
  const auto recording = recording::read_recording(settings.motion);
  if (!recording) return fail_in("twin.motion", Error{Errc::bad_config, recording.error().what});
  return make_recorded_motion(*recording, settings);
}

}  // namespace handcast::twin
