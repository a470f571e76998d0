// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

/// The texts of shaders/*.glsl, embedded by the build.
namespace handcast::renderer::gl {

/// Functions that all shaders may call.
extern const std::string_view kCommon;
/// Draws the triangles of one hand.
/// @{
extern const std::string_view kDrawVertex, kDrawFragment;
/// @}
/// Draws the cells of a warp grid.
/// @{
extern const std::string_view kWarpVertex, kWarpFragment;
/// @}
/// The two steps of the fill.
/// @{
extern const std::string_view kSortCompute, kFillCompute;
/// @}

}  // namespace handcast::renderer::gl
