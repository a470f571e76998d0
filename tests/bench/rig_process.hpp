// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ipc/control/control_message.hpp"
#include "ipc/ring/ring_view.hpp"

namespace handcast::bench {

/// Starts a program, whose output is appended to a file. It ends when this process ends.
pid_t start(const std::vector<std::string>& words, const std::filesystem::path& log);
/// Waits for its end. Returns its exit code, or -1.
int wait_for(pid_t pid);

/// A temporary folder for the rigs of a benchmark. It is the HANDCAST_SCOPE of this process, so
/// that they meet no others.
class RigScope {
 public:
  RigScope();
  ~RigScope();
  RigScope(const RigScope&) = delete;

  const std::filesystem::path& path() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

/// `handcast up`. A rig that cannot be asked ends the benchmark.
class RigProcess {
 public:
  /// Starts the rig `name` by the command `words`.
  RigProcess(std::string name, const std::vector<std::string>& words,
             const std::filesystem::path& log);
  ~RigProcess();  ///< stops it, and says so if it did not end well
  RigProcess(const RigProcess&) = delete;

  /// Waits until `is_ready` returns true for the services of `handcast status`.
  void wait_until(const std::function<bool(const nlohmann::json& services)>& is_ready) const;
  pid_t pid_of(const std::string& service) const;
  ipc::RingView view_of(const std::string& stream) const;
  /// Sends a request and waits for its answer.
  nlohmann::json ask(const control::Request& request) const;

 private:
  std::string name_;
  pid_t pid_ = -1;
};

}  // namespace handcast::bench
