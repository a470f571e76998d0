// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "services/camera/v4l2/exposure.hpp"

namespace handcast::camera::v4l2 {

/// What the kernel's time stamp of an image says.
enum class StampOf {
  exposure_start,  ///< when the exposure began
  arrival,         ///< when the last byte of the image arrived
  nothing,         ///< it is of another clock than CLOCK_MONOTONIC
};

/// What is known of the times of an image. Times are CLOCK_MONOTONIC.
struct ImageTimes {
  StampOf stamp_of = StampOf::nothing;
  std::int64_t stamp_ns = 0;    ///< the kernel's time stamp
  std::int64_t fetched_ns = 0;  ///< when the service got the image
};

/// What holds for all images of a stream.
struct StreamTimes {
  Exposure exposure;
  std::int64_t delivery_ns = 0;  ///< camera.delivery_ms
  std::int64_t period_ns = 0;    ///< from image to image
};

/// The middle of an exposure, and half the width of the interval in which it lies.
struct Origin {
  std::int64_t time_ns = 0, error_ns = 0;
};

/// The middle of the exposure of an image.
///
/// exposure_start: half an exposure after the stamp; the error is that of the exposure, and that of
/// the stamp (1 us, the resolution of the kernel's struct).
/// arrival: delivery_ns and half an exposure before the stamp. delivery_ns is the least time; a
/// period is taken as the longest time by which images are later.
/// nothing: the same with fetched_ns; the image may have waited for the service for a period more.
///
/// A stamp after fetched_ns or more than 1 s before it is wrong (cameras with a bad clock), and
/// taken for `nothing`.
Origin origin_of(const ImageTimes& image, const StreamTimes& stream);

}  // namespace handcast::camera::v4l2
