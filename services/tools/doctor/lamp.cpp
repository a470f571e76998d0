// SPDX-License-Identifier: Apache-2.0
#include "services/tools/doctor/lamp.hpp"

#include <fmt/format.h>

#include "ipc/base/join.hpp"
#include "services/desk/lamp/pjlink.hpp"

namespace handcast::doctor {

std::vector<Finding> examine_lamp(const config::Rig& rig, std::chrono::nanoseconds patience) {
  const auto& settings = rig.projector.lamp;
  if (settings.pjlink.empty()) return {};
  const auto status = desk::lamp::place_of(settings).and_then([&](const desk::lamp::Place& place) {
    return desk::lamp::ask(place, Deadline::in(patience));
  });
  if (!status)
    return {{"lamp", Grade::fault, status.error().what,
             "`handcast lamp --file RIG.toml` tells when it is mended"}};
  if (!status->faults.empty())
    return {{"lamp", Grade::fault, "the projector reports " + join(status->faults, ", "),
             "its manual says what to do"}};
  const bool is_dark = status->power != desk::lamp::Status::Power::on || status->is_muted;
  return {{"lamp", is_dark ? Grade::advice : Grade::good,
           fmt::format("the projector's lamp is {}{}", desk::lamp::words_for(status->power),
                       status->is_muted ? ", its shutter is closed" : ""),
           is_dark ? "`handcast lamp on` turns it on" : ""}};
}

}  // namespace handcast::doctor
