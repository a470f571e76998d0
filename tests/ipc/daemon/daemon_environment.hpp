// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <stdlib.h>

#include "ipc/daemon/contract.hpp"
#include "ipc/daemon/handover.hpp"

namespace handcast::daemon {

/// This process's environment as a supervisor would make it, as long as the object lives.
class DaemonEnvironment {
 public:
  explicit DaemonEnvironment(const Handover& handover) {
    clear();
    for (const auto& variable : to_environment(handover)) {
      const auto equals = variable.find('=');
      setenv(variable.substr(0, equals).c_str(), variable.substr(equals + 1).c_str(), 1);
    }
  }
  ~DaemonEnvironment() { clear(); }
  DaemonEnvironment(const DaemonEnvironment&) = delete;

 private:
  static void clear() {
    for (const char* variable : kHandoverVariables) unsetenv(variable);
  }
};

}  // namespace handcast::daemon
