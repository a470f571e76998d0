// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "services/desk/base/panel.hpp"

namespace handcast::desk::osc {

/// What OSCQuery tells about the host.
struct Host {
  std::string name;  ///< of the rig
  int port = 0;      ///< where OSC is taken by UDP
};

/// The JSON that OSCQuery answers to "/projector", "/light/blackout?VALUE" or "/?HOST_INFO": the
/// live settings and the commands below an address, or one attribute of it. Empty if there is no
/// such address; "" if it has no such attribute.
std::optional<std::string> describe_address(std::string_view query, const Host& host,
                                            std::span<const Control> controls, const Values& values,
                                            std::span<const std::string> presets);

}  // namespace handcast::desk::osc
