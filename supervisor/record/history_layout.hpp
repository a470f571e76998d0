// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "ipc/msg/stage_mark.hpp"

/// The layout of a snapshot of the history: FileHead, the names of the services, then for each
/// frame a FrameHead and its marks. The memory of the history has the same frames. Numbers have the
/// byte order of the machine, since the same machine reads them.
namespace handcast::supervisor {

/// The first bytes of a snapshot.
struct FileHead {
  static constexpr std::uint64_t kMagic = 0x32'5453'4948'4348;  ///< "HCHIST2"
  std::uint64_t magic = kMagic;                                 ///< kMagic
  std::uint64_t bytes = 0;                                      ///< size of the whole file
  std::int64_t taken_ns = 0;    ///< when the snapshot was taken, CLOCK_MONOTONIC
  std::int32_t supervisor = 0;  ///< pid of the supervisor
  std::uint32_t services = 0;   ///< number of names that follow
};
using ServiceName = std::array<char, 32>;  ///< the name of a service, NUL-terminated

/// The first bytes of a frame: see FrameRecord.
struct FrameHead {
  std::uint32_t service = 0;   ///< index into the names
  std::uint32_t missed = 0;    ///< FrameRecord::missed
  msg::Header header;          ///< FrameRecord::header
  msg::MadeFrom made_from;     ///< FrameRecord::made_from
  std::uint32_t marks = 0;     ///< number of marks that follow
  std::uint32_t reserved = 0;  ///< padding
};

/// The largest number of marks of a frame.
inline constexpr std::size_t kMostMarks = std::tuple_size_v<decltype(msg::StageMarks::marks)>;

/// Size of a frame with its marks.
inline constexpr std::size_t bytes_of(const FrameHead& head) {
  return sizeof(FrameHead) + head.marks * sizeof(msg::StageMark);
}

/// True if a mark is valid. Marks are read from memory that other processes write.
inline bool makes_sense(const msg::StageMark& mark) {
  return mark.stage < msg::Stage::count && mark.begin_ns >= 0 && mark.end_ns >= mark.begin_ns;
}

}  // namespace handcast::supervisor
