// SPDX-License-Identifier: Apache-2.0
#include "renderer/content/textures.hpp"

#include <fmt/format.h>

#include "renderer/content/builtin.hpp"
#include "renderer/media/picture.hpp"

namespace handcast::renderer {

Result<Texture> load_content(const std::string& what, const HandMesh& hand) {
  constexpr std::string_view kBuiltin = "builtin:";
  if (!what.starts_with(kBuiltin)) return read_picture(what);
  const std::string name = what.substr(kBuiltin.size());
  if (auto texture = paint_builtin(name, hand)) return std::move(*texture);
  return fail(Errc::bad_config, fmt::format("There is no built-in content '{}'; the names are {}.",
                                            name, kBuiltinNames));
}

}  // namespace handcast::renderer
