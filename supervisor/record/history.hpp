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

// contract
namespace handcast::supervisor {

/// What one service spent on one frame.
struct FrameRecord {
  std::uint32_t service = 0;  ///< index into the names
  std::uint32_t missed = 0;   ///< frames of this service before this one whose marks were
                              ///< overwritten before they were read
  msg::Header header;
  msg::MadeFrom made_from;            ///< of a projector frame
  std::vector<msg::StageMark> marks;  ///< in the order of their making; none ends before it begins
};

/// The recorder's memory of the last frames: bounded in time and in bytes, in the order in which
/// they were read.
class History {
 public:
  static constexpr std::size_t kBlockBytes = 256 << 10;
  static constexpr std::size_t kMostBlocks = 256;  ///< 64 MiB: some 200 s of a rig at full rate

  explicit History(double seconds) : span_ns_(static_cast<std::int64_t>(seconds * 1e9)) {}
  /// How far back it is to reach from now on.
  void reach(double seconds) { span_ns_ = static_cast<std::int64_t>(seconds * 1e9); }

  /// Gives the service its place in the order of the services, before its first frame.
  void expect(std::string_view service) { index_of(service); }
  /// Heart-beats are not kept, nor marks that make no sense. Allocates only until the history is as
  /// long as it gets.
  void note(std::string_view service, const msg::StageMarks& marks, std::uint64_t missed);
  /// Everything since `since_ns` as a memory file (sealed, read_history() reads it): what a tool
  /// gets over the control socket. Errors: unavailable.
  Result<UniqueFd> snapshot(std::int64_t since_ns) const;
  std::size_t bytes() const { return blocks_.size() * kBlockBytes; }

 private:
  /// Frames one behind the other: a head and its marks (history.cpp).
  struct Block {
    std::unique_ptr<std::byte[]> memory;
    std::size_t used = 0;
    std::int64_t oldest_ns = 0, newest_ns = 0;
  };
  struct Service {
    std::string name;
    std::uint64_t missed = 0;  ///< not yet told with a frame
  };

  std::uint32_t index_of(std::string_view service);
  Block& block_with_room(std::size_t bytes, std::int64_t time_ns);
  std::vector<std::span<const std::byte>> frames_since(std::int64_t since_ns) const;

  std::int64_t span_ns_;
  std::int64_t newest_ns_ = 0;
  std::vector<Service> services_;
  std::vector<Block> blocks_;  ///< the oldest first
};

/// A snapshot as read back.
struct HistorySnapshot {
  std::int64_t taken_ns = 0;
  pid_t supervisor = 0;
  std::vector<std::string> services;
  std::vector<FrameRecord> frames;
};
/// Errors: bad_data.
Result<HistorySnapshot> read_history(const UniqueFd& file);

}  // namespace handcast::supervisor
