// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/desk/page/errand.hpp"

namespace handcast::desk {

/// A recording of `handcast record`.
struct Recording {
  std::string name;          ///< of its folder
  double seconds = 0;        ///< from its first message to its last one
  std::uintmax_t bytes = 0;  ///< of its files
};

/// The recordings in a folder, the newest first; 200 at most.
std::vector<Recording> recordings_in(const std::filesystem::path& folder);

/// The programs that an owner starts from the page: a recording and the doctor, one of each at a
/// time. They end with the desk.
class Programs {
 public:
  static constexpr int kLongestRecording_s = 3600;

  /// `rig_file`: empty if it is not known. `recordings`: the folder, made when it is needed.
  Programs(std::string rig, std::filesystem::path rig_file, std::filesystem::path recordings);

  /// Starts to record into a folder of this name; "": one named after the time. Errors: bad_config
  /// (not a name, there is one already, no folder is set), unavailable (one is being made, or the
  /// folder cannot be made). Any thread.
  Result<void> start_recording(std::string name);
  /// Errors: bad_config (none is being made). Any thread.
  Result<void> stop_recording();
  /// Errors: bad_config (the rig file is not known), unavailable (it is at work). Any thread.
  Result<void> start_doctor();

  /// What pages are told, as JSON: rig_watch.cpp says when. One thread.
  /// @{
  /// {"folder", "running": {"name", "seconds"} or null, "fault", "all": [{"name", "seconds",
  /// "bytes"}]}
  std::string recordings();
  /// {"running", "findings": [{"check", "grade", "sentence", "remedy"}] or null, "fault"}
  std::string doctor() const;
  /// @}

 private:
  std::string recording_name() const;

  std::string rig_;
  std::filesystem::path rig_file_, folder_;
  mutable std::mutex mutex_;  ///< of `name_`
  std::string name_;          ///< of the recording that is being made
  std::vector<Recording> all_;
  std::int64_t listed_ns_ = 0;
  bool was_recording_ = false;
  Errand recorder_, doctor_;
};

}  // namespace handcast::desk
