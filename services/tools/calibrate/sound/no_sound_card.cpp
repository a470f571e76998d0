// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/sound/sound_card.hpp"

namespace handcast::calibrate {

Result<std::unique_ptr<SoundCard>> open_sound_card(const std::string&) {
  return fail(Errc::bad_config,
              "this build cannot read a photodiode (libasound2-dev was not found)");
}

}  // namespace handcast::calibrate
