// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

namespace handcast::msg {

/// The streams of programs that are not part of the rig, for the back ends `external`: CameraFrame,
/// HandPoses and Landmarks. Pictures for the hands: see kGuestPictures. Of the services, only the
/// bridge writes to them; the supervisor gives their rings to programs with the right to write, so
/// services check what they read there (check_guest()).
/// @{
inline constexpr std::string_view kGuestImages = "guest.camera";
inline constexpr std::string_view kSecondGuestImages = "guest.camera2";
inline constexpr std::string_view kGuestPoses = "guest.pose";
inline constexpr std::string_view kGuestLandmarks = "guest.landmarks";
inline constexpr std::string_view kSecondGuestLandmarks = "guest.landmarks2";
/// @}

/// Whether programs outside the rig write to a stream.
constexpr bool is_for_guests(std::string_view stream) { return stream.starts_with("guest."); }

}  // namespace handcast::msg
