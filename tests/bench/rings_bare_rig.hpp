// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <map>
#include <string>

#include "tests/bench/rig_process.hpp"

namespace handcast::bench {

/// A folder with the real `handcast` and bare daemons (tests/system/bare_daemon.cpp) under the
/// names of its services.
class BarePrograms {
 public:
  BarePrograms();

  const std::filesystem::path& folder() const { return scope_.path(); }

 private:
  RigScope scope_;
};

/// `handcast up` with bare daemons, from the moment when all of them are ready.
class BareRig : public RigProcess {
 public:
  BareRig(const BarePrograms& programs, bool standby);

  /// The services that can be killed, and the stream each publishes.
  static const std::map<std::string, std::string>& streams();
};

}  // namespace handcast::bench
