// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include "services/devices/attached.hpp"
#ifdef HANDCAST_WITH_HIDAPI
#include "services/dlp/hid_device.hpp"
#endif

namespace handcast::devices {

#ifdef HANDCAST_WITH_HIDAPI
namespace {

constexpr std::uint16_t kTexasInstruments = 0x0451;

/// The controller with this USB product id; "" if it is none.
std::string_view model_of(std::uint16_t product_id) {
  if (product_id == 0x6401) return "DLPC350 (LightCrafter 4500)";
  if (product_id == 0xc900) return "DLPC900 (LightCrafter 6500, 9000)";
  return "";
}

}  // namespace

std::vector<Attached> controllers() {
  std::vector<Attached> attached;
  for (const auto& info : dlp::list_hid_devices(kTexasInstruments)) {
    const auto model = model_of(info.product_id);
    if (model.empty()) continue;
    const bool is_permitted = ::access(info.path.c_str(), R_OK | W_OK) == 0;
    attached.push_back(
        {.kind = Kind::controller,
         .name = fmt::format("{}, serial number {}, {}", model,
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
