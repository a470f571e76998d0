// SPDX-License-Identifier: Apache-2.0
#include "services/camera/v4l2/origin.hpp"

namespace handcast::camera::v4l2 {

Origin origin_of(const ImageTimes& image, const StreamTimes& stream) {
  constexpr std::int64_t kResolution_ns = 1000, kOldest_ns = 1'000'000'000;
  const std::int64_t half_ns = stream.exposure.time_ns / 2;
  const std::int64_t exposure_error_ns = stream.exposure.error_ns / 2;
  const bool is_credible =
      image.stamp_ns <= image.fetched_ns && image.stamp_ns >= image.fetched_ns - kOldest_ns;
  const auto stamp_of = is_credible ? image.stamp_of : StampOf::nothing;
  if (stamp_of == StampOf::exposure_start)
    return {image.stamp_ns + half_ns, exposure_error_ns + kResolution_ns};
  const std::int64_t before_ns = stream.delivery_ns + half_ns;
  if (stamp_of == StampOf::arrival)
    return {image.stamp_ns - before_ns, exposure_error_ns + stream.period_ns};
  return {image.fetched_ns - before_ns, exposure_error_ns + 2 * stream.period_ns};
}

}  // namespace handcast::camera::v4l2
