// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "services/camera/leap/payload.hpp"

namespace handcast::camera::leap {

/// An image of the stream that has ended.
struct EndedFrame {
  bool is_whole = false;               ///< all of its bytes came
  bool frame_id = false;               ///< changes from each image to the next
  std::optional<std::uint32_t> stamp;  ///< of its first payload that came
  std::int64_t first_ns = 0;           ///< arrival of that payload, CLOCK_MONOTONIC
  std::int64_t last_ns = 0;            ///< arrival of the last one
};

/// Puts the payloads of a stream together to images. An image is whole if its bytes are exactly
/// those of a frame and it ends with the mark of its end; everything else is torn. Payloads are
/// distinguished by the frame id and, because a loss can hide two changes of it, by their stamps.
/// One thread.
class FrameAssembler {
 public:
  /// `frame_bytes`: of an image. `split_ticks`: a stamp so much later than that of the payload
  /// before belongs to another image; 0: stamps tell nothing.
  FrameAssembler(std::size_t frame_bytes, std::uint32_t split_ticks);

  /// What a payload ended: an image that began before it and will not be finished, and its own.
  struct Ended {
    std::optional<EndedFrame> torn;  ///< the one before
    std::optional<EndedFrame> own;   ///< the payload's
  };
  /// Takes the next payload as it came from the camera.
  Ended take(std::span<const std::uint8_t> payload, std::int64_t arrived_ns);
  /// A payload did not arrive. Its image is torn.
  void lose_payload();

  /// The bytes of the image that ended whole, until the next call of take(). The caller may put
  /// another buffer in their place.
  std::vector<std::uint8_t>& bytes() { return bytes_; }
  /// Payloads without a header, and behind the end of their image, since the beginning.
  std::uint64_t strays() const { return strays_; }

 private:
  bool is_of_another_frame(const Payload& payload) const;
  bool is_behind_its_end(const Payload& payload) const;
  void begin(const Payload& payload, std::int64_t arrived_ns);
  void append(const Payload& payload, std::int64_t arrived_ns);
  EndedFrame end(bool with_mark);

  std::size_t frame_bytes_;
  std::uint32_t split_ticks_;
  std::vector<std::uint8_t> bytes_;
  std::size_t filled_ = 0;
  bool is_open_ = false;    ///< an image has begun
  bool is_broken_ = false;  ///< and cannot become whole
  bool has_ended_ = false;  ///< an image has ended before
  EndedFrame frame_;        ///< the open image, or the last one
  std::optional<std::uint32_t> last_stamp_;
  std::uint64_t strays_ = 0;
};

}  // namespace handcast::camera::leap
