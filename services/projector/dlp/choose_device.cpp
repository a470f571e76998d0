// SPDX-License-Identifier: Apache-2.0
#include "services/projector/dlp/choose_device.hpp"

#include <fmt/format.h>

#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"

namespace handcast::dlp {
namespace {

constexpr std::uint16_t kVendor = 0x0451;  ///< Texas Instruments

std::string list_of(const std::vector<HidInfo>& devices) {
  std::vector<std::string> texts;
  texts.reserve(devices.size());
  for (const auto& device : devices)
    texts.push_back(fmt::format("'{}' ({})", device.serial, device.path));
  return texts.empty() ? "none" : join(texts, ", ");
}

}  // namespace

std::optional<protocol::Controller> controller_of(const HidInfo& device) {
  if (device.product_id == 0x6401) return protocol::Controller::dlpc350;
  if (device.product_id == 0xc900) return protocol::Controller::dlpc900;
  return std::nullopt;
}

std::vector<HidInfo> attached_controllers() {
  auto attached = list_hid_devices(kVendor);
  std::erase_if(attached, [](const HidInfo& device) { return !controller_of(device); });
  return attached;
}

Result<HidInfo> choose_device(const std::string& wanted) {
  const auto attached = attached_controllers();
  std::vector<HidInfo> fitting;
  for (const auto& device : attached)
    if (wanted.empty() || wanted == device.serial || wanted == device.path)
      fitting.push_back(device);
  if (fitting.size() == 1) return fitting.front();
  if (fitting.size() > 1)
    return fail(Errc::bad_config,
                fmt::format("dlp.device: several controllers are attached; set it "
                            "to the serial number or path of one: {}",
                            list_of(fitting)));
  if (wanted.empty())
    return fail(
        Errc::unavailable,
        "no DLPC350 or DLPC900 is attached; connect the projector's USB cable and switch it on");
  return fail(Errc::unavailable, fmt::format("dlp.device: there is no controller {}; attached: {}",
                                             quote(wanted), list_of(attached)));
}

}  // namespace handcast::dlp
