// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

/// How a ring lies in its segment, in bytes from the start:
///
///   0              SegmentHeader, written once by the segment's maker
///   4096           lines of 128 bytes: head, epoch, a state per slot, a row per reader; then the
///   tallies: the writer's, one per reader slots_offset   the slots, `slot_stride` apart: one
///   message each, tail included
///
/// Nothing in a segment is a pointer.
namespace handcast::ipc {

inline constexpr std::uint64_t kSegmentMagic = 0x676e'6972'7473'6163;  ///< "castring"
inline constexpr std::uint32_t kLayoutVersion = 2;  ///< raise it when anything in this file changes

inline constexpr std::size_t kPageBytes = 4096;
/// Two cache lines: processors fetch lines in pairs, so a neighbour's word must be two lines away.
inline constexpr std::size_t kLineBytes = 128;

inline constexpr int kMinSlots =
    2;  ///< the newest message stays readable while the next one is written
inline constexpr int kMaxSlots = 254;  ///< a slot's number + 1 has eight bits in a lease word
inline constexpr int kReaderRows = 16;
inline constexpr int kLeasesPerRow = 2;
inline constexpr std::size_t kMaxPayloadBytes = std::size_t{1} << 30;
inline constexpr std::size_t kMaxSegmentBytes = std::size_t{1} << 32;

struct SegmentHeader {
  std::uint64_t magic = kSegmentMagic;
  std::uint32_t layout_version = kLayoutVersion;
  std::uint32_t slot_count = 0;
  std::uint64_t segment_bytes = 0;
  std::uint64_t payload_bytes = 0;
  std::uint64_t slot_stride = 0;
  std::uint64_t slots_offset = 0;
  std::uint32_t reader_rows = kReaderRows;
  std::uint32_t leases_per_row = kLeasesPerRow;
  std::uint32_t keep_history = 0;
  std::uint32_t reserved = 0;
  std::uint64_t type_hash = 0;
  std::int64_t created_ns =
      0;  ///< CLOCK_MONOTONIC, so it means something only within the boot below
  std::array<char, 40> boot_id{};  ///< text, NUL-terminated
  std::array<char, 64> stream{};   ///< text, NUL-terminated
};
static_assert(std::is_trivially_copyable_v<SegmentHeader> && sizeof(SegmentHeader) <= kPageBytes);

constexpr std::size_t round_up(std::size_t bytes, std::size_t unit) {
  return (bytes + unit - 1) / unit * unit;
}

/// Two for the ring, one per slot, one per reader.
constexpr std::size_t control_lines(int slots, int rows) {
  return 2 + static_cast<std::size_t>(slots) + static_cast<std::size_t>(rows);
}
/// One for the writer, one per reader.
constexpr std::size_t tally_lines(int rows) { return 1 + static_cast<std::size_t>(rows); }

inline constexpr std::size_t kControlOffset = kPageBytes;
constexpr std::size_t tally_offset(int slots) {
  return kControlOffset + control_lines(slots, kReaderRows) * kLineBytes;
}

/// Fills in the sizes that follow from slot_count and payload_bytes.
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
