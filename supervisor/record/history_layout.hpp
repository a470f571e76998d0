// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "ipc/msg/stage_mark.hpp"

/// How frames lie in the history's memory and in its snapshots: FileHead, the services' names, then
/// per frame a FrameHead and its marks. One machine writes and reads it, so the numbers are as the
/// machine has them.
namespace handcast::supervisor {

struct FileHead {
  static constexpr std::uint64_t kMagic = 0x32'5453'4948'4348;  ///< "HCHIST2"
  std::uint64_t magic = kMagic;
  std::uint64_t bytes = 0;  ///< of the whole file
  std::int64_t taken_ns = 0;
  std::int32_t supervisor = 0;
  std::uint32_t services = 0;
};
using ServiceName = std::array<char, 32>;  ///< ends with a zero

struct FrameHead {
  std::uint32_t service = 0;
  std::uint32_t missed = 0;
  msg::Header header;
  msg::MadeFrom made_from;
  std::uint32_t marks = 0;
  std::uint32_t reserved = 0;
};

inline constexpr std::size_t kMostMarks = std::tuple_size_v<decltype(msg::StageMarks::marks)>;

inline constexpr std::size_t bytes_of(const FrameHead& head) {
  return sizeof(FrameHead) + head.marks * sizeof(msg::StageMark);
}

/// Marks come from memory that others write.
inline bool makes_sense(const msg::StageMark& mark) {
  return mark.stage < msg::Stage::count && mark.begin_ns >= 0 && mark.end_ns >= mark.begin_ns;
}

}  // namespace handcast::supervisor
