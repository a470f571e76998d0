// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

/// The layout of a ring in its segment. Offsets in bytes:
///
///     0             SegmentHeader, written once when the segment is created
///     4096          lines of 128 bytes: head, epoch, one state per slot, one row per reader,
///                   then the tallies: one of the writer, one per reader
///     slots_offset  the slots, `slot_stride` apart: one message each, tail included
///
/// A segment contains no pointers.
namespace handcast::ipc {

inline constexpr std::uint64_t kSegmentMagic = 0x676e'6972'7473'6163;  ///< "castring"
inline constexpr std::uint32_t kLayoutVersion = 2;  ///< raise it when anything in this file changes

inline constexpr std::size_t kPageBytes = 4096;  ///< alignment of the parts of a segment
/// Two cache lines: processors prefetch lines in pairs, so words of different processes must be two
/// lines apart.
inline constexpr std::size_t kLineBytes = 128;

/// The smallest number of slots: the newest message stays readable while the next one is written.
inline constexpr int kMinSlots = 2;
inline constexpr int kMaxSlots = 254;    ///< a lease word has eight bits for the slot plus 1
inline constexpr int kReaderRows = 16;   ///< the most readers of a ring
inline constexpr int kLeasesPerRow = 2;  ///< the most messages that one reader can lease
inline constexpr std::size_t kMaxPayloadBytes = std::size_t{1} << 30;  ///< of one message
inline constexpr std::size_t kMaxSegmentBytes = std::size_t{1} << 32;  ///< of all slots together

/// The first bytes of a segment. They never change after the segment was created.
struct SegmentHeader {
  std::uint64_t magic = kSegmentMagic;            ///< kSegmentMagic
  std::uint32_t layout_version = kLayoutVersion;  ///< kLayoutVersion of the creator
  std::uint32_t slot_count = 0;                   ///< kMinSlots .. kMaxSlots
  std::uint64_t segment_bytes = 0;                ///< size of the whole segment
  std::uint64_t payload_bytes = 0;                ///< size of the largest message, tail included
  std::uint64_t slot_stride = 0;                  ///< bytes from one slot to the next
  std::uint64_t slots_offset = 0;                 ///< bytes from the start to the first slot
  std::uint32_t reader_rows = kReaderRows;        ///< kReaderRows of the creator
  std::uint32_t leases_per_row = kLeasesPerRow;   ///< kLeasesPerRow of the creator
  std::uint32_t keep_history = 0;                 ///< 1: RingSpec::keep_history
  std::uint32_t reserved = 0;                     ///< padding
  std::uint64_t type_hash = 0;                    ///< msg::type_hash<T>() of the message type
  std::int64_t created_ns = 0;                    ///< CLOCK_MONOTONIC of the boot in `boot_id`
  std::array<char, 40> boot_id{};                 ///< text, NUL-terminated
  std::array<char, 64> stream{};                  ///< text, NUL-terminated
};
static_assert(std::is_trivially_copyable_v<SegmentHeader> && sizeof(SegmentHeader) <= kPageBytes);

/// The smallest multiple of `unit` that is at least `bytes`.
constexpr std::size_t round_up(std::size_t bytes, std::size_t unit) {
  return (bytes + unit - 1) / unit * unit;
}

/// Number of lines with control words: head, epoch, one per slot, one per reader.
constexpr std::size_t control_lines(int slots, int rows) {
  return 2 + static_cast<std::size_t>(slots) + static_cast<std::size_t>(rows);
}
/// Number of lines with tallies: one of the writer, one per reader.
constexpr std::size_t tally_lines(int rows) { return 1 + static_cast<std::size_t>(rows); }

/// Offset of the control words in bytes.
inline constexpr std::size_t kControlOffset = kPageBytes;
/// Offset of the tallies in bytes.
constexpr std::size_t tally_offset(int slots) {
  return kControlOffset + control_lines(slots, kReaderRows) * kLineBytes;
}

/// `header` with slots_offset, slot_stride and segment_bytes computed from slot_count and
/// payload_bytes.
constexpr SegmentHeader with_sizes(SegmentHeader header) {
  header.slots_offset = round_up(
      tally_offset(static_cast<int>(header.slot_count)) + tally_lines(kReaderRows) * kLineBytes,
      kPageBytes);
  header.slot_stride = round_up(header.payload_bytes, kLineBytes);
  header.segment_bytes =
      round_up(header.slots_offset + header.slot_count * header.slot_stride, kPageBytes);
  return header;
}

}  // namespace handcast::ipc
