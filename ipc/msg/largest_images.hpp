// SPDX-License-Identifier: Apache-2.0
#pragma once

/// @file
/// The largest images that fit into a ring. The supervisor makes the rings before it knows the
/// sizes of the rig's own images.

namespace handcast::msg {

/// Of the camera: one byte per pixel.
/// @{
inline constexpr int kLargestCameraWidth_px = 1280;
inline constexpr int kLargestCameraHeight_px = 1024;
/// @}
/// Of the projector: four bytes per pixel.
/// @{
inline constexpr int kLargestProjectorWidth_px = 1024;
inline constexpr int kLargestProjectorHeight_px = 768;
/// @}
/// Of a test picture: one byte per pixel.
/// @{
inline constexpr int kLargestTestPictureWidth_px = 3840;
inline constexpr int kLargestTestPictureHeight_px = 2400;
/// @}

}  // namespace handcast::msg
