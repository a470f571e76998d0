// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "renderer/draw/gl/passes.hpp"
#include "renderer/draw/gl/shaders.hpp"

namespace handcast::renderer::gl {

Result<Drawer> Drawer::create(Context& context, glm::ivec2 size_px) {
  auto program = make_program(context, {{GL_VERTEX_SHADER, "draw_vertex", kDrawVertex},
                                        {GL_FRAGMENT_SHADER, "draw_fragment", kDrawFragment}});
  if (!program) return tl::make_unexpected(program.error());
  context.gl().ProgramUniform2f(program->name(), 0, static_cast<float>(size_px.x),
                                static_cast<float>(size_px.y));
  return Drawer(context, std::move(*program));
}

Drawer::Drawer(Context& context, Program program)
    : context_(&context),
      program_(std::move(program)),
      vertices_(make_vertex_array(context)),
      ring_(std::make_unique<UploadRing>(context)) {
  const Functions& gl = context.gl();
  const GLuint array = vertices_.name();
  gl.VertexArrayAttribFormat(array, 0, 2, GL_FLOAT, GL_FALSE, 0);
  gl.VertexArrayAttribIFormat(array, 1, 1, GL_UNSIGNED_INT, sizeof(glm::vec2));
  gl.VertexArrayAttribFormat(array, 2, 4, GL_FLOAT, GL_FALSE, 0);
  for (const GLuint attribute : {0u, 1u, 2u}) {
    gl.EnableVertexArrayAttrib(array, attribute);
    gl.VertexArrayAttribBinding(array, attribute, attribute == 2 ? 1 : 0);
  }
}

/// Writes the placed vertices of a hand. Returns the side of its triangles that is drawn.
cpu::Facing Drawer::place(const DrawnHand& hand, Placed* placed) {
  const bool shaded = !hand.light.empty();
  corners_.resize(hand.mesh->vertex_count());
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const glm::vec2 at = hand.position_px[i];
    cpu::Corner& corner = corners_[i];
    corner.x = cpu::snapped(at.x);
    corner.y = cpu::snapped(at.y);
    corner.depth = hand.depth_m[i];
    placed[i] = {static_cast<float>(corner.x) / 16, static_cast<float>(corner.y) / 16, corner.depth,
                 shaded ? 255 * std::clamp(hand.light[i], 0.f, 1.f) : 255};
  }
  return cpu::facing_of(corners_, hand.mesh->triangles, areas_);
}

void Drawer::draw_hand(const HandAssets& assets, int index, cpu::Facing facing,
                       std::size_t offset) {
  const Functions& gl = context_->gl();
  if (facing == cpu::Facing::both) {
    gl.Disable(GL_CULL_FACE);
  } else {
    gl.Enable(GL_CULL_FACE);
    gl.CullFace(facing == cpu::Facing::positive ? GL_BACK : GL_FRONT);
  }
  gl.ProgramUniform1ui(program_.name(), 1, surface_id(index, 0));
  const glm::ivec4 picture = assets.picture->place();
  gl.ProgramUniform4i(program_.name(), 2, picture.x, picture.y, picture.z, picture.w);
  gl.BindTextureUnit(0, assets.picture->texels.name());
  gl.VertexArrayVertexBuffer(vertices_.name(), 0, assets.mesh->vertices.name(), 0,
                             MeshCopy::kVertexBytes);
  gl.VertexArrayVertexBuffer(vertices_.name(), 1, ring_->buffer(), static_cast<GLintptr>(offset),
                             sizeof(Placed));
  gl.VertexArrayElementBuffer(vertices_.name(), assets.mesh->triangles.name());
  gl.DrawElements(GL_TRIANGLES, assets.mesh->index_count, GL_UNSIGNED_SHORT, nullptr);
}

void Drawer::draw(std::span<const DrawnHand> hands, std::span<const HandAssets> assets,
                  const Rect& region, const Layers& out) {
  std::size_t vertices = 0;
  for (const DrawnHand& hand : hands) vertices += hand.mesh->vertex_count();
  auto* placed = reinterpret_cast<Placed*>(ring_->next(vertices * sizeof(Placed)));
  if (placed == nullptr) return;
  facings_.clear();
  for (const DrawnHand& hand : hands) {
    facings_.push_back(place(hand, placed));
    placed += hand.mesh->vertex_count();
  }
  const Functions& gl = context_->gl();
  begin_drawing(*context_, out, region);
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LEQUAL);
  gl.UseProgram(program_.name());
  gl.BindVertexArray(vertices_.name());
  std::size_t offset = ring_->offset();
  for (std::size_t i = 0; i < hands.size(); ++i) {
    draw_hand(assets[i], static_cast<int>(i), facings_[i], offset);
    offset += hands[i].mesh->vertex_count() * sizeof(Placed);
  }
  ring_->sent();
}

}  // namespace handcast::renderer::gl
