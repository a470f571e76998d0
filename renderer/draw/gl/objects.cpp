// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/gl/objects.hpp"

#include <algorithm>
#include <utility>

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

UploadRing::~UploadRing() { release_slots(); }

void UploadRing::release_slots() {
  if (!context_.make_current()) return;
  for (GLsync& fence : in_use_)
    if (fence != nullptr) context_.gl().DeleteSync(std::exchange(fence, nullptr));
}

std::byte* UploadRing::next(std::size_t bytes) {
  if (bytes > slot_bytes_ || slot_bytes_ == 0) {
    release_slots();  // the old buffer lives until the GPU has read it
    slot_bytes_ = (std::max<std::size_t>(bytes, 1) * 3 / 2 + 255) / 256 * 256;
    mapped_ = MappedBuffer(context_, kSlots * slot_bytes_, GL_MAP_WRITE_BIT);
  }
  slot_ = (slot_ + 1) % kSlots;
  if (in_use_[slot_] != nullptr) wait(context_, std::exchange(in_use_[slot_], nullptr));
  if (context_.lost()) return nullptr;
  return mapped_.data + offset();
}

void UploadRing::sent() {
  in_use_[slot_] = context_.gl().FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
}

PassTimer::PassTimer(Context& context, bool on) : context_(context), on_(on) {
  if (!on) return;
  for (Query& query : queries_) {
    GLuint name = 0;
    context.gl().CreateQueries(GL_TIME_ELAPSED, 1, &name);
    query = Query(context, name);
  }
}

void PassTimer::begin(Pass pass) {
  if (on_) context_.gl().BeginQuery(GL_TIME_ELAPSED, queries_[static_cast<int>(pass)].name());
}

void PassTimer::end(Pass pass) {
  if (!on_) return;
  context_.gl().EndQuery(GL_TIME_ELAPSED);
  used_[static_cast<int>(pass)] = true;
}

PassTimes PassTimer::take() {
  PassTimes times{};
  for (std::size_t i = 0; i < times.size() && context_.make_current(); ++i) {
    if (!std::exchange(used_[i], false)) continue;
    GLuint64 elapsed_ns = 0;
    context_.gl().GetQueryObjectui64v(queries_[i].name(), GL_QUERY_RESULT, &elapsed_ns);
    times[i] = static_cast<double>(elapsed_ns) / 1000;
  }
  return times;
}

}  // namespace handcast::renderer::gl
