// SPDX-License-Identifier: Apache-2.0
#include "services/camera/leap/payload.hpp"

#include <fmt/format.h>

#include "services/camera/leap/little_endian.hpp"

namespace handcast::camera::leap {
namespace {

/// Bits of the header's second byte.
enum : unsigned {
  kFrameId = 0x01,
  kEndOfFrame = 0x02,
  kStamp = 0x04,
  kSourceClock = 0x08,
  kError = 0x40,
  kEndOfHeader = 0x80,
};
constexpr std::size_t kFixedBytes = 2, kStampBytes = 4, kSourceClockBytes = 6;

}  // namespace

Result<Payload> parse_payload(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kFixedBytes)
    return fail(Errc::bad_data, fmt::format("a payload of {} bytes has no header", bytes.size()));
  const std::size_t length = bytes[0];
  const unsigned flags = bytes[1];
  const std::size_t least = kFixedBytes + ((flags & kStamp) != 0 ? kStampBytes : 0) +
                            ((flags & kSourceClock) != 0 ? kSourceClockBytes : 0);
  if ((flags & kEndOfHeader) == 0 || length < least || length > bytes.size())
    return fail(Errc::bad_data,
                fmt::format("a payload of {} bytes has a header of {} bytes with the flags {:#04x}",
                            bytes.size(), length, flags));
  Payload payload;
  payload.frame_id = (flags & kFrameId) != 0;
  payload.ends_frame = (flags & kEndOfFrame) != 0;
  payload.has_error = (flags & kError) != 0;
  if ((flags & kStamp) != 0) payload.stamp = get_32(bytes, kFixedBytes);
  payload.data = bytes.subspan(length);
  return payload;
}

}  // namespace handcast::camera::leap
