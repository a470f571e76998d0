// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/gl/functions.hpp"

#include <fmt/format.h>

namespace handcast::renderer::gl {

Result<Functions> load_functions(FindFunction find) {
  Functions gl;
#define HANDCAST_GL_LOAD(type, name)                               \
  gl.name = reinterpret_cast<PFNGL##type##PROC>(find("gl" #name)); \
  if (gl.name == nullptr)                                          \
    return fail(Errc::unavailable, fmt::format("the driver has no function gl{}", #name));
  HANDCAST_GL_FUNCTIONS(HANDCAST_GL_LOAD)
#undef HANDCAST_GL_LOAD
  return gl;
}

}  // namespace handcast::renderer::gl
