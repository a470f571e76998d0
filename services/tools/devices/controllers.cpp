// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include "services/tools/devices/attached.hpp"
#ifdef HANDCAST_WITH_HIDAPI
#include "services/projector/dlp/choose_device.hpp"
#endif

namespace handcast::devices {

#ifdef HANDCAST_WITH_HIDAPI
namespace {

/// With the names under which its boards are sold.
std::string_view model_of(dlp::protocol::Controller controller) {
  return controller == dlp::protocol::Controller::dlpc350 ? "DLPC350 (LightCrafter 4500)"
                                                          : "DLPC900 (LightCrafter 6500, 9000)";
}

}  // namespace

std::vector<Attached> controllers() {
  std::vector<Attached> attached;
  for (const auto& info : dlp::attached_controllers()) {
    const bool is_permitted = ::access(info.path.c_str(), R_OK | W_OK) == 0;
    attached.push_back(
        {.kind = Kind::controller,
         .name = fmt::format("{}, serial number {}, {}", model_of(*dlp::controller_of(info)),
                             info.serial.empty() ? "unknown" : info.serial, info.path),
         .about = info.product,
         .settings = {{"dlp.backend", "lightcrafter"},
                      {"dlp.device", info.serial.empty() ? info.path : info.serial}},
         .trouble = is_permitted ? ""
                                 : "this user may not open it; scripts/setup --udev installs the "
                                   "rules that permit it",
         .names =
             info.serial.empty() ? std::vector{info.path} : std::vector{info.serial, info.path}});
  }
  return attached;
}
#else
std::vector<Attached> controllers() { return {}; }
#endif

}  // namespace handcast::devices
