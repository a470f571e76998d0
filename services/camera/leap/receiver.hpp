// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "ipc/msg/frame_losses.hpp"
#include "services/camera/keep/mailbox.hpp"
#include "services/camera/leap/frame_assembler.hpp"
#include "services/camera/leap/frame_times.hpp"
#include "services/camera/leap/payload.hpp"

namespace handcast::camera::leap {

/// The images of both eyes: byte 2i is pixel i of the left one, byte 2i + 1 of the right one.
struct StereoImage {
  std::vector<std::uint8_t> bytes;    ///< two for each pixel
  std::uint64_t number = 0;           ///< see Mailbox
  std::int64_t exposed_ns = 0;        ///< the middle of the exposure, CLOCK_MONOTONIC
  std::int64_t exposed_error_ns = 0;  ///< uncertainty of exposed_ns
  msg::FrameLosses lost;              ///< see Mailbox
};

using Mailbox = camera::Mailbox<StereoImage>;

/// What holds for all images of a stream.
struct StreamFacts {
  std::size_t frame_bytes = 0;    ///< of an image of both eyes
  std::size_t payload_bytes = 0;  ///< the largest payload, with its header
  std::int64_t period_ns = 0;     ///< from image to image
  std::uint32_t clock_hz = 0;     ///< ticks of the stamps in a second; 0: not known
  std::int64_t exposure_ns = 0;   ///< duration of the exposure
  std::int64_t delivery_ns = 0;   ///< from the end of the exposure to the first byte of the image
};

/// Makes images of the payloads of one stream and puts them into the mailbox, with their times and
/// what was lost before. On the stream's thread.
class Receiver final : public PayloadSink {
 public:
  /// For a stream that has not begun.
  Receiver(const StreamFacts& facts, std::shared_ptr<Mailbox> mailbox);

  void on_payload(std::span<const std::uint8_t> bytes, std::int64_t arrived_ns) override;
  void on_lost_payload() override;

 private:
  void finish(const EndedFrame& frame);

  StreamFacts facts_;
  std::shared_ptr<Mailbox> mailbox_;
  FrameAssembler assembler_;
  FrameTimes times_;
  std::int64_t before_arrival_ns_;  ///< from the middle of the exposure to the first payload
  StereoImage image_;
};

}  // namespace handcast::camera::leap
