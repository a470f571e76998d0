// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::calibrate {

/// A rig that runs as long as this object: `handcast up` as a child process. One thread.
class OwnRig {
 public:
  /// Starts the rig of a file with settings of --set, and waits until its camera has sent an image.
  /// What it prints goes to `log`. Errors: unavailable (it cannot be started, or ended; the
  /// sentence has its last words), timeout (no image came in 30 s).
  static Result<OwnRig> start(const std::filesystem::path& rig_file, const std::string& name,
                              const std::vector<std::string>& settings,
                              const std::filesystem::path& log);
  OwnRig(OwnRig&& other) noexcept;
  OwnRig& operator=(OwnRig&&) = delete;
  ~OwnRig() { stop(); }

  /// Stops the rig and waits until it is down.
  void stop();

  /// Error unavailable if the rig has ended, or this program was asked to stop.
  Result<void> check();

 private:
  OwnRig(pid_t child, std::filesystem::path log) : child_(child), log_(std::move(log)) {}
  Result<void> wait_for_images(const std::string& name);
  std::string last_words() const;

  pid_t child_;  ///< 0: none
  std::filesystem::path log_;
};

}  // namespace handcast::calibrate
