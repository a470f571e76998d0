// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string_view>

#include "renderer/base/image.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// "atlas", "checker", "skeleton" or "white" for this hand; nothing for any other name.
std::optional<Texture> paint_builtin(std::string_view name, const HandMesh& hand);

/// The names, as a person reads them in an error.
constexpr std::string_view kBuiltinNames = "atlas, checker, skeleton, white";

}  // namespace handcast::renderer
