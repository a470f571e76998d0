// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "renderer/draw/gl/passes.hpp"
#include "renderer/draw/gl/shaders.hpp"

namespace handcast::renderer::gl {

Result<Warper> Warper::create(Context& context, glm::ivec2 size_px) {
  auto program = make_program(context, {{GL_VERTEX_SHADER, "warp_vertex", kWarpVertex},
                                        {GL_FRAGMENT_SHADER, "warp_fragment", kWarpFragment}});
  if (!program) return tl::make_unexpected(program.error());
  context.gl().ProgramUniform2f(program->name(), 0, static_cast<float>(size_px.x),
                                static_cast<float>(size_px.y));
  return Warper(context, std::move(*program));
}

Warper::Warper(Context& context, Program program)
    : context_(&context),
      program_(std::move(program)),
      vertices_(make_vertex_array(context)),
      ring_(std::make_unique<UploadRing>(context)) {
  const Functions& gl = context.gl();
  gl.VertexArrayAttribFormat(vertices_.name(), 0, 4, GL_FLOAT, GL_FALSE, 0);
  gl.VertexArrayAttribBinding(vertices_.name(), 0, 0);
  gl.EnableVertexArrayAttrib(vertices_.name(), 0);
}

void Warper::warp(const WarpGrid& grid, const Rect& from, const Rect& region, const Layers& in,
                  const Layers& out) {
  cells_.set(grid, from);
  const std::size_t node_bytes = cells_.corners.size() * sizeof(glm::vec4),
                    index_bytes = cells_.triangles.size() * sizeof(cells_.triangles[0]);
  std::byte* const data = ring_->next(node_bytes + index_bytes);
  if (data == nullptr) return;
  auto* node = reinterpret_cast<glm::vec4*>(data);
  for (const cpu::Corner& corner : cells_.corners)
    *node++ = {static_cast<float>(corner.x) / 16, static_cast<float>(corner.y) / 16, corner.u,
               corner.v};
  std::memcpy(data + node_bytes, cells_.triangles.data(), index_bytes);

  const Functions& gl = context_->gl();
  begin_drawing(*context_, out, region);
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_CULL_FACE);
  gl.UseProgram(program_.name());
  gl.ProgramUniform4i(program_.name(), 1, from.x0, from.y0, from.x1, from.y1);
  gl.BindTextureUnit(0, in.uv.name());
  gl.BindTextureUnit(1, in.tag.name());
  gl.BindTextureUnit(2, in.colour.name());
  gl.VertexArrayVertexBuffer(vertices_.name(), 0, ring_->buffer(),
                             static_cast<GLintptr>(ring_->offset()), sizeof(glm::vec4));
  gl.VertexArrayElementBuffer(vertices_.name(), ring_->buffer());
  gl.BindVertexArray(vertices_.name());
  gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * cells_.triangles.size()),
                  GL_UNSIGNED_SHORT, ring_->pointer(node_bytes));
  ring_->sent();
}

}  // namespace handcast::renderer::gl
