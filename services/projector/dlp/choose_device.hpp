// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/projector/dlp/hid_device.hpp"
#include "services/projector/dlp/protocol/command.hpp"

namespace handcast::dlp {

/// The controller in a device of Texas Instruments; empty if it is none of those.
std::optional<protocol::Controller> controller_of(const HidInfo& device);

/// The attached controllers that handcast knows.
std::vector<HidInfo> attached_controllers();

/// The attached controller that `wanted` means (dlp.device): a serial number or a path; empty: the
/// only one. Errors, with a list of those that are attached: unavailable (it is not there),
/// bad_config (several fit).
Result<HidInfo> choose_device(const std::string& wanted);

}  // namespace handcast::dlp
