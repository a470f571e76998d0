// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::renderer {

/// Keeps the user's desktop from blanking or locking the screen for lack of input, by the method
/// Inhibit of org.freedesktop.ScreenSaver on the session bus (D-Bus specification 0.42). It lasts
/// until the object or the process ends, because the desktop notices that the connection is closed.
class IdleInhibitor {
 public:
  /// Asks the desktop. `reason`: what it shows to people. Errors: unavailable (no session bus, or
  /// no desktop that can be asked).
  static Result<IdleInhibitor> open(const std::string& reason);

 private:
  explicit IdleInhibitor(UniqueFd bus) : bus_(std::move(bus)) {}
  UniqueFd bus_;  ///< the connection
};

}  // namespace handcast::renderer
