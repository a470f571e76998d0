// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// Loads the content of a hand. `what`: a PNG or JPEG file in the texture layout of the hand, or
/// "builtin:NAME", painted over the charts of the mesh in 1024x640 texels: atlas (numbered fields,
/// bands on the fingers, outlines; shows errors of alignment), checker, skeleton or white. Built-in
/// colours continue outside the charts, because the fill looks up texels there. Errors
/// (bad_config): see read_picture(), or no such name.
Result<Texture> load_content(const std::string& what, const HandMesh& hand);

/// What to say about a picture of other proportions than the template of handcast's own hands, onto
/// which it is stretched. Empty if they differ by 1 % at most.
std::string note_on_proportions(const std::string& what, const Texture& picture);

}  // namespace handcast::renderer
