// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "calib/clock_map.hpp"
#include "services/camera/leap/frame_assembler.hpp"

namespace handcast::camera::leap {

/// Numbers the images of a stream and maps their times to CLOCK_MONOTONIC.
///
/// The stamp of an image counts ticks of the camera's clock, of which the controller has 1000 a
/// second: enough to number the images, too coarse for their times. So an image's time on the
/// camera's clock is its number times the period, which is measured over many images by the stamps;
/// ClockMap maps it by the earliest arrivals. Without credible stamps the frame id shows an odd
/// number of lost images, and the time of an image is that of its arrival. Stamps are credible as
/// long as no image arrives long before it was taken; it may arrive late by any time. One thread.
class FrameTimes {
 public:
  /// `clock_hz`: ticks per second of the stamps, as the camera says; 0: not known.
  FrameTimes(std::uint32_t clock_hz, std::int64_t period_ns);

  /// The place of an image in the stream.
  struct Place {
    std::uint64_t steps = 1;      ///< number of periods since the image before, at least 1
    std::int64_t arrival_ns = 0;  ///< the earliest time at which its first payload can have arrived
    std::int64_t error_ns = 0;    ///< how far arrival_ns may be off
  };
  /// The next image, whole or torn.
  Place add(const EndedFrame& frame);

 private:
  std::uint64_t steps_to(const EndedFrame& frame);
  std::uint64_t steps_by_stamps(const EndedFrame& frame) const;
  void refine_period();

  double ticks_per_s_;
  double period_ns_;           ///< by the camera's clock
  double ticks_ = 0;           ///< since the first stamp
  double number_ = 0;          ///< images since the first stamp
  double refine_at_ = 512;     ///< the number at which the period is measured next
  double device_ns_ = 0;       ///< the image's time on the camera's clock
  std::int64_t begun_ns_ = 0;  ///< arrival of the first image
  double least_delay_ns_ = 0;  ///< of an image's arrival behind its time on the camera's clock
  bool has_begun_ = false;
  bool are_stamps_good_;
  int bad_in_a_row_ = 0;
  EndedFrame last_;
  calib::ClockMap clock_;
};

}  // namespace handcast::camera::leap
