// SPDX-License-Identifier: Apache-2.0
#include "renderer/window/levels.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

namespace handcast::renderer {
namespace {

/// One triangle that covers the buffer.
constexpr const char* kVertex = R"(#version 330 core
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";

/// The rows of a window run from the bottom to the top.
constexpr const char* kFragment = R"(#version 330 core
uniform usampler2D image;
uniform sampler2D levels;
uniform vec2 image_per_window;
out vec4 light;

float level(uint from) { return texelFetch(levels, ivec2(int(from & 255u), 0), 0).r; }

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy * image_per_window);
  at.y = textureSize(image, 0).y - 1 - at.y;
  uint rgba = texelFetch(image, at, 0).r;
  light = vec4(0.0, 0.0, 0.0, 1.0);
  if (rgba >> 24 != 0u) light.rgb = vec3(level(rgba), level(rgba >> 8), level(rgba >> 16));
}
)";

void attach(GLuint program, GLenum type, const char* text) {
  const GLuint shader = glCreateShader(type);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  glAttachShader(program, shader);
  glDeleteShader(shader);  // as soon as the program is deleted
}

}  // namespace

LevelsShader::LevelsShader() {
  program_ = glCreateProgram();
  attach(program_, GL_VERTEX_SHADER, kVertex);
  attach(program_, GL_FRAGMENT_SHADER, kFragment);
  glLinkProgram(program_);
  GLint linked = 0;
  glGetProgramiv(program_, GL_LINK_STATUS, &linked);
  works_ = linked == GL_TRUE;
  glUseProgram(program_);
  glUniform1i(glGetUniformLocation(program_, "image"), 0);
  glUniform1i(glGetUniformLocation(program_, "levels"), 1);
  glUseProgram(0);
  glGenVertexArrays(1, &vertices_);
  glGenSamplers(1, &sampler_);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glSamplerParameteri(sampler_, filter, GL_NEAREST);
  glGenTextures(1, &levels_);
  glBindTexture(GL_TEXTURE_2D, levels_);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, static_cast<GLsizei>(uploaded_.size()), 1, 0, GL_RED,
               GL_UNSIGNED_BYTE, uploaded_.data());
  glBindTexture(GL_TEXTURE_2D, 0);
}

LevelsShader::~LevelsShader() {
  glDeleteTextures(1, &levels_);
  glDeleteSamplers(1, &sampler_);
  glDeleteVertexArrays(1, &vertices_);
  glDeleteProgram(program_);
}

void LevelsShader::upload(const LightTable& table) {
  if (table == uploaded_) return;
  uploaded_ = table;
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, static_cast<GLsizei>(table.size()), 1, GL_RED,
                  GL_UNSIGNED_BYTE, table.data());
}

void LevelsShader::draw(const DeviceImage& image, Rect region, const LightTable& table,
                        int to_width_px, int to_height_px) {
  glClear(GL_COLOR_BUFFER_BIT);
  region = region.within(image.width_px, image.height_px);
  if (region.empty()) return;
  const auto x = [&](int px) { return px * to_width_px / image.width_px; };
  const auto y = [&](int px) { return to_height_px - px * to_height_px / image.height_px; };
  glViewport(0, 0, to_width_px, to_height_px);
  glEnable(GL_SCISSOR_TEST);
  glScissor(x(region.x0), y(region.y1), x(region.x1) - x(region.x0), y(region.y0) - y(region.y1));
  glUseProgram(program_);
  glUniform2f(glGetUniformLocation(program_, "image_per_window"),
              static_cast<float>(image.width_px) / static_cast<float>(to_width_px),
              static_cast<float>(image.height_px) / static_cast<float>(to_height_px));
  glBindVertexArray(vertices_);
  for (const GLuint unit : {0u, 1u}) {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, unit == 0 ? image.texture : levels_);
    glBindSampler(unit, sampler_);
  }
  upload(table);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  for (const GLuint unit : {1u, 0u}) {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, 0);
    glBindSampler(unit, 0);
  }
  glUseProgram(0);
  glDisable(GL_SCISSOR_TEST);
}

}  // namespace handcast::renderer
