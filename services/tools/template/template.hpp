// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string_view>
#include <vector>

#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"
#include "renderer/hand/hand_mesh.hpp"

/// `handcast template`: the layout in which pictures lie on the hands, to paint on.
namespace handcast::picture {

/// The proportions of a template, as those of the built-in contents. Others are stretched.
inline constexpr int kProportionWidth = 8, kProportionHeight = 5;

/// A drawing of the texture layout of a hand, black and grey on white: the borders of the parts of
/// the surface, the lines between the bones, and words: the fingers, back and palm, and an arrow to
/// the fingertips ("up"). `side`: "left" or "right". `width_px`: a multiple of 8; the height is
/// 5/8.
renderer::Image<std::uint8_t> line_drawing(const renderer::HandMesh& hand, std::string_view side,
                                           int width_px);

/// Writes SIDE.png (builtin:atlas, whose fields and fingers are numbered, with the same words) and
/// SIDE_lines.png (the drawing above) of both hands of a rig into a folder, which is created.
/// Returns the files. Errors: bad_config (a hand cannot be read, the folder cannot be created, one
/// of the files exists: it may have been painted on), those of renderer::write_png().
Result<std::vector<std::filesystem::path>> write_templates(const config::Hand& hands,
                                                           const std::filesystem::path& folder,
                                                           int width_px);

}  // namespace handcast::picture
