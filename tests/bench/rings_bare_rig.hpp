// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "ipc/ring/ring_view.hpp"

namespace handcast::bench {

/// A folder with the real `handcast` and bare daemons (tests/system/bare_daemon.cpp) under the
/// names of its services. The folder is also where its rigs meet: HANDCAST_SCOPE of this process
/// is set to it.
class BarePrograms {
 public:
  BarePrograms();
  ~BarePrograms();
  BarePrograms(const BarePrograms&) = delete;

  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

/// `handcast up` with bare daemons, from the moment when all of them are ready.
class BareRig {
 public:
  BareRig(const BarePrograms& programs, bool standby);
  ~BareRig();  ///< stops it, and says so where it did not end well
  BareRig(const BareRig&) = delete;

  /// The services that can be killed, and the stream each publishes.
  static const std::map<std::string, std::string>& streams();
  pid_t pid_of(const std::string& service) const;
  ipc::RingView view_of(const std::string& stream) const;

 private:
  nlohmann::json status() const;
  bool is_ready(bool standby) const;

  pid_t pid_ = -1;
};

}  // namespace handcast::bench
