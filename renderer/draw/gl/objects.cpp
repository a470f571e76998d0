// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/gl/objects.hpp"

#include <algorithm>

namespace handcast::renderer::gl {

Buffer make_buffer(Context& context, std::size_t bytes, GLbitfield flags, const void* data) {
  GLuint name = 0;
  context.gl().CreateBuffers(1, &name);
  context.gl().NamedBufferStorage(name, static_cast<GLsizeiptr>(std::max<std::size_t>(bytes, 1)),
                                  data, flags);
  return {context, name};
}

Image2d make_image(Context& context, GLenum format, int width, int height) {
  GLuint name = 0;
  context.gl().CreateTextures(GL_TEXTURE_2D, 1, &name);
  context.gl().TextureStorage2D(name, 1, format, width, height);
  // Textures of integers are incomplete with the filters they are made with.
  context.gl().TextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  context.gl().TextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return {context, name};
}

VertexArray make_vertex_array(Context& context) {
  GLuint name = 0;
  context.gl().CreateVertexArrays(1, &name);
  return {context, name};
}

Framebuffer make_framebuffer(Context& context) {
  GLuint name = 0;
  context.gl().CreateFramebuffers(1, &name);
  return {context, name};
}

MappedBuffer::MappedBuffer(Context& context, std::size_t bytes, GLbitfield access) {
  const GLbitfield flags = access | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  // Memory that the processor reads must be its own, or each read crosses the bus.
  const GLbitfield storage = access == GL_MAP_READ_BIT ? flags | GL_CLIENT_STORAGE_BIT : flags;
  buffer = make_buffer(context, bytes, storage);
  data = static_cast<std::byte*>(context.gl().MapNamedBufferRange(
      buffer.name(), 0, static_cast<GLsizeiptr>(std::max<std::size_t>(bytes, 1)), flags));
  if (data == nullptr) context.lose("the GPU has no memory that can be mapped");
}

void wait(Context& context, GLsync fence) {
  const Functions& gl = context.gl();
  const GLuint64 limit_ns = context.gpu().is_software ? 20'000'000'000 : 250'000'000;
  const GLenum result = gl.ClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, limit_ns);
  if (result == GL_TIMEOUT_EXPIRED) context.lose("the GPU did not finish in time");
  if (result == GL_WAIT_FAILED) context.check();
  gl.DeleteSync(fence);
}

}  // namespace handcast::renderer::gl
