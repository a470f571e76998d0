// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

/// The programs of handcast that a calibration starts: the rig, and the one that makes the page.
namespace handcast::calibrate {

/// Error unavailable if the program was asked to stop, by Ctrl-C or SIGTERM.
Result<void> not_stopped();

/// The rig that is measured: `handcast up` as a child process, which runs as long as this object,
/// or one that was up before and goes on. One thread.
class OwnRig {
 public:
  /// Starts the rig of a file with settings of --set, and waits until its camera has sent an image.
  /// What it prints goes to `log`. Errors: unavailable (it cannot be started, or ended; the
  /// sentence has its last words), timeout (no image came in 30 s).
  static Result<OwnRig> start(const std::filesystem::path& rig_file, const std::string& name,
                              const std::vector<std::string>& settings,
                              const std::filesystem::path& log);
  /// A rig that is up, and goes on when this object ends. Errors: those of client::stream_names().
  static Result<OwnRig> beside(const std::string& name);
  OwnRig(OwnRig&& other) noexcept;
  OwnRig& operator=(OwnRig&&) = delete;
  ~OwnRig() { stop(); }

  /// Stops a rig that was started and waits until it is down.
  void stop();

  /// Error unavailable if a rig that was started has ended, or this program was asked to stop.
  Result<void> check();

 private:
  OwnRig(pid_t child, std::filesystem::path log) : child_(child), log_(std::move(log)) {}
  Result<void> wait_for_images(const std::string& name);

  pid_t child_;            ///< 0: none
  bool is_other_ = false;  ///< it was up before
  std::filesystem::path log_;
};

/// Makes report.html of the JSON files in the folder of a session. Takes some seconds. Error
/// unavailable: the page could not be made, with the reason, e.g. the Debian package that is
/// missing.
Result<void> write_page(const std::filesystem::path& folder);

}  // namespace handcast::calibrate
