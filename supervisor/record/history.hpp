// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"
#include "ipc/msg/stage_mark.hpp"

namespace handcast::supervisor {

/// The stages of one frame in one service.
struct FrameRecord {
  std::uint32_t service = 0;  ///< index into HistorySnapshot::services
  /// Number of frames of this service before this one whose marks were overwritten before the
  /// recorder read them.
  std::uint32_t missed = 0;
  msg::Header header;       ///< frame_id, origin and time of publication of the frame
  msg::MadeFrom made_from;  ///< the inputs of a projector frame; zeros in all other frames
  std::vector<msg::StageMark> marks;  ///< in the order of StageMarks; none ends before it begins
};

/// The frames of the last seconds of all services, in the order in which the recorder read them.
/// Bounded in time and in bytes. One thread.
class History {
 public:
  static constexpr std::size_t kBlockBytes = 256 << 10;  ///< size of a block of memory
  /// The largest number of blocks: 64 MiB, about 200 s of a rig at full rate.
  static constexpr std::size_t kMostBlocks = 256;

  /// A history of the last `seconds`.
  explicit History(double seconds) : span_ns_(static_cast<std::int64_t>(seconds * 1e9)) {}
  /// Changes the length of the history.
  void set_span(double seconds) { span_ns_ = static_cast<std::int64_t>(seconds * 1e9); }

  /// Adds a service to the list of services before its first frame, so that it has a fixed place.
  void add_service(std::string_view service) { index_of(service); }
  /// Adds a frame. Heartbeats (no marks) and invalid marks are left out. `missed`: see FrameRecord.
  /// Allocates memory only until the history has its full length.
  void add(std::string_view service, const msg::StageMarks& marks, std::uint64_t missed);
  /// The frames published since `since_ns` (CLOCK_MONOTONIC) as a sealed memory file for
  /// read_history(), which is sent over the control socket. Errors: unavailable (no memory or
  /// descriptor).
  Result<UniqueFd> snapshot(std::int64_t since_ns) const;
  /// Memory in use.
  std::size_t bytes() const { return blocks_.size() * kBlockBytes; }

 private:
  /// A block of frames, each a FrameHead and its marks (history_layout.hpp).
  struct Block {
    std::unique_ptr<std::byte[]> memory;
    std::size_t used = 0;
    std::int64_t oldest_ns = 0, newest_ns = 0;
  };
  struct Service {
    std::string name;
    std::uint64_t missed = 0;  ///< not yet reported with a frame
  };

  std::uint32_t index_of(std::string_view service);
  Block& block_with_room(std::size_t bytes, std::int64_t time_ns);
  std::vector<std::span<const std::byte>> frames_since(std::int64_t since_ns) const;

  std::int64_t span_ns_;
  std::int64_t newest_ns_ = 0;
  std::vector<Service> services_;
  std::vector<Block> blocks_;  ///< the oldest first
};

/// The contents of a snapshot.
struct HistorySnapshot {
  std::int64_t taken_ns = 0;          ///< when it was taken, CLOCK_MONOTONIC
  pid_t supervisor = 0;               ///< pid of the supervisor that took it
  std::vector<std::string> services;  ///< names of the services
  std::vector<FrameRecord> frames;    ///< in the order in which the recorder read them
};
/// Reads a snapshot. All values are checked, because the file comes from another process. Errors:
/// bad_data (the file is not a valid snapshot).
Result<HistorySnapshot> read_history(const UniqueFd& file);

}  // namespace handcast::supervisor
