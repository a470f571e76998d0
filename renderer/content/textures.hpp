// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// What a hand wears: a PNG/JPEG file in the hand's texture layout, or "builtin:NAME" painted over
/// the mesh's own charts: atlas (numbered fields, finger bands, an outline: shows every mistake of
/// alignment), checker, skeleton, white. 1024x640 for the built-in ones. Colours are padded past
/// the charts' outline so that the fill finds them there.
Result<Texture> load_content(const std::string& what, const HandMesh& hand);

}  // namespace handcast::renderer
