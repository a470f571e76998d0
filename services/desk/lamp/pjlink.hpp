// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "config/sections/light.hpp"
#include "config/sections/projector.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"

/// A projector's lamp over the network: PJLink class 1 (JBMIA), TCP.
namespace handcast::desk::lamp {

/// Where a projector takes commands. The password is never printed.
struct Place {
  std::string host, port, password;
};

/// The place that [projector.lamp] names, with the password of its file or of
/// HANDCAST_PJLINK_PASSWORD. Errors: bad_config (no place, a file that cannot be read or that
/// others can read, a password that PJLink does not know).
Result<Place> place_of(const config::ProjectorLamp& settings);

/// What a projector says of itself.
struct Status {
  enum class Power { off, on, cooling, warming };
  struct Hours {
    int hours = 0;
    bool is_on = false;
  };
  std::string name;
  Power power = Power::off;
  bool is_muted = false;            ///< the shutter is closed
  std::string input;                ///< two digits; empty: it does not say
  std::vector<Hours> lamps;         ///< how long each has burnt
  std::vector<std::string> faults;  ///< "fan: error", "filter: warning"
};

/// The words for a power state: "off", "on", "cooling down", "warming up".
std::string_view words_for(Status::Power power);

/// Each opens a connection and closes it again. Both block until the deadline at most, or, within
/// 0.1 s, until a stop is requested; the name of a host may take longer to be found. Errors:
/// timeout (no answer in time), unavailable (no connection, or it cannot now), disconnected,
/// bad_data (no PJLink, or a fault of the projector), bad_config (the password, the host, or a
/// command that it does not know).
/// @{
Result<Status> ask(const Place& place, Deadline deadline, const std::stop_token& stop = {});

/// Goes towards a state: false if it is not reached, because the lamp warms up or cools down: do it
/// again later. `input`: see config::ProjectorLamp.
Result<bool> tell(const Place& place, config::Lamp wanted, std::string_view input,
                  Deadline deadline, const std::stop_token& stop = {});
/// @}

}  // namespace handcast::desk::lamp
