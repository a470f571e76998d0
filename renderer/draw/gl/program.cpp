// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/gl/program.hpp"

#include <fmt/format.h>

#include <array>
#include <string>

#include "renderer/draw/gl/shaders.hpp"

namespace handcast::renderer::gl {
namespace {

/// The driver's message on one line.
std::string reason_of(const std::string& log) {
  std::string line = log.substr(0, log.find('\0'));
  while (!line.empty() && (line.back() == '\n' || line.back() == ' ')) line.pop_back();
  for (char& c : line)
    if (c == '\n') c = ';';
  return line.empty() ? "no reason given" : line;
}

Result<GLuint> compile(const Functions& gl, const ShaderSource& source) {
  constexpr std::string_view kVersion = "#version 450 core\n", kLine = "#line 1\n";
  const std::array parts{kVersion, kCommon, kLine, source.text};
  std::array<const GLchar*, parts.size()> texts{};
  std::array<GLint, parts.size()> lengths{};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    texts[i] = parts[i].data();
    lengths[i] = static_cast<GLint>(parts[i].size());
  }
  const GLuint shader = gl.CreateShader(source.stage);
  gl.ShaderSource(shader, parts.size(), texts.data(), lengths.data());
  gl.CompileShader(shader);
  GLint is_good = GL_FALSE;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &is_good);
  if (is_good) return shader;
  std::string log(2000, '\0');
  gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  gl.DeleteShader(shader);
  return fail(Errc::unavailable, fmt::format("the driver cannot compile the shader {}: {}",
                                             source.name, reason_of(log)));
}

}  // namespace

Result<Program> make_program(Context& context, std::initializer_list<ShaderSource> sources) {
  const Functions& gl = context.gl();
  Program program(context, gl.CreateProgram());
  for (const ShaderSource& source : sources) {
    const auto shader = compile(gl, source);
    if (!shader) return tl::make_unexpected(shader.error());
    gl.AttachShader(program.name(), *shader);
    gl.DeleteShader(*shader);  // with the program
  }
  gl.LinkProgram(program.name());
  GLint is_good = GL_FALSE;
  gl.GetProgramiv(program.name(), GL_LINK_STATUS, &is_good);
  if (is_good) return program;
  std::string log(2000, '\0');
  gl.GetProgramInfoLog(program.name(), static_cast<GLsizei>(log.size()), nullptr, log.data());
  return fail(Errc::unavailable, fmt::format("the driver cannot link the shader {}: {}",
                                             sources.begin()->name, reason_of(log)));
}

}  // namespace handcast::renderer::gl
