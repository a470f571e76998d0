// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string_view>

namespace handcast::recording {

/// One message in the index of a stream, NAME.index. Little-endian, as on every machine that
/// handcast runs on. docs/recordings.md describes the files.
struct IndexRow {
  std::uint64_t offset = 0;                   ///< where the message begins in NAME.data
  std::uint32_t head_bytes = 0;               ///< stored size of the message without its image
  std::uint32_t image_bytes = 0;              ///< size of the packed image, which follows
  std::uint32_t width_px = 0, height_px = 0;  ///< of the image; 0: there is none
  std::uint64_t frame_id = 0;                 ///< these three: as in the header of the message
  std::int64_t origin_ns = 0;
  std::int64_t published_ns = 0;
  std::uint64_t sequence = 0;  ///< number of the message in its ring
  std::uint32_t lost = 0;      ///< messages between the row before and this one that are missing
  std::uint32_t crc = 0;       ///< CRC-32 of the stored bytes

  std::uint64_t end() const { return offset + head_bytes + image_bytes; }
};
static_assert(sizeof(IndexRow) == 64);

/// A field of a structure in the words of numpy.
struct NumpyField {
  std::string_view name, type;
};
/// The fields of IndexRow, in their order.
inline constexpr std::array<NumpyField, 11> kIndexFields{{{"offset", "<u8"},
                                                          {"head_bytes", "<u4"},
                                                          {"image_bytes", "<u4"},
                                                          {"width_px", "<u4"},
                                                          {"height_px", "<u4"},
                                                          {"frame_id", "<u8"},
                                                          {"origin_ns", "<i8"},
                                                          {"published_ns", "<i8"},
                                                          {"sequence", "<u8"},
                                                          {"lost", "<u4"},
                                                          {"crc", "<u4"}}};

}  // namespace handcast::recording
