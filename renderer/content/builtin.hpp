// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string_view>

#include "renderer/base/image.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// Paints one of kBuiltinNames over the charts of `hand`. Empty if there is no such name.
std::optional<Texture> paint_builtin(std::string_view name, const HandMesh& hand);

/// The names of the built-in contents, for messages.
constexpr std::string_view kBuiltinNames = "atlas, checker, skeleton, white";

}  // namespace handcast::renderer
