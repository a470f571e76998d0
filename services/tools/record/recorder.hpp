// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/recording/recording_writer.hpp"
#include "services/tools/record/feed.hpp"
#include "services/tools/record/options.hpp"

namespace handcast::record {

/// Records rings of a rig: one thread for each ring with images and one for all others copy
/// messages to memory of limited size; one thread of low priority packs and writes them.
class Recorder {
 public:
  using Totals = std::vector<recording::RecordingWriter::Total>;

  /// The feeds are those of the streams of `writer`, in their order.
  Recorder(std::vector<std::unique_ptr<Feed>> feeds, recording::RecordingWriter writer);

  /// Why a recording ended, and how long it is.
  struct End {
    std::string reason;
    double seconds = 0;
  };

  /// Records until `is_over` is true, the rig is down or the disk is full. Calls `look` about once
  /// a second, and at the end, with what was written; it may take its time. Errors: unavailable
  /// (the disk is full, or cannot be written): everything before is in the recording.
  Result<End> run(const std::function<bool()>& is_over,
                  const std::function<void(const Totals&)>& look);

 private:
  void read(const std::vector<Feed*>& feeds, std::int64_t pause_ns);
  void write();
  void stop(Error reason);
  Totals totals();
  Result<std::string> finish();

  std::vector<std::unique_ptr<Feed>> feeds_;
  recording::RecordingWriter writer_;
  MessageQueue queue_;
  std::atomic<bool> stopping_{false};
  std::mutex mutex_;   ///< of the following
  Totals totals_;      ///< so far
  Result<void> well_;  ///< the first error
};

/// Records a rig as the command line says, with a line of progress on a terminal and a table at the
/// end. Errors: unavailable (no rig is up; the disk is full), bad_config (the folder or a ring
/// cannot be taken), those of write_npy_folder().
Result<void> record(const Options& options);

}  // namespace handcast::record
