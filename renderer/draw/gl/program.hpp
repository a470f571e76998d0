// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <initializer_list>
#include <string_view>

#include "renderer/draw/gl/objects.hpp"

namespace handcast::renderer::gl {

/// One stage of a program.
struct ShaderSource {
  GLenum stage;           ///< e.g. GL_VERTEX_SHADER
  std::string_view name;  ///< for messages, e.g. "draw_vertex"
  std::string_view text;  ///< GLSL without the line of its version
};

/// Compiles and links a program. Each text is preceded by the line of its version and common.glsl.
/// Errors (unavailable): the driver refuses a shader; the message has its name and the driver's
/// reason.
Result<Program> make_program(Context& context, std::initializer_list<ShaderSource> sources);

}  // namespace handcast::renderer::gl
