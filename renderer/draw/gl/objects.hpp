// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <utility>

#include "renderer/draw/gl/context.hpp"

namespace handcast::renderer::gl {

/// A name of OpenGL that is deleted with this object. `kDelete`: its function, a member of
/// Functions. The context must outlive it.
template <auto kDelete>
class Object {
 public:
  /// No object.
  Object() = default;
  /// Takes the name.
  Object(Context& context, GLuint name) : context_(&context), name_(name) {}
  /// Moves the name.
  /// @{
  Object(Object&& other) noexcept
      : context_(other.context_), name_(std::exchange(other.name_, 0)) {}
  Object& operator=(Object&& other) noexcept {
    std::swap(context_, other.context_);
    std::swap(name_, other.name_);
    return *this;
  }
  /// @}
  ~Object() {
    if (name_ == 0 || !context_->make_current()) return;
    if constexpr (requires(const Functions& gl) { (gl.*kDelete)(1, &name_); }) {
      (context_->gl().*kDelete)(1, &name_);
    } else {
      (context_->gl().*kDelete)(name_);
    }
  }

  /// The name; 0: none.
  GLuint name() const { return name_; }

 private:
  Context* context_ = nullptr;
  GLuint name_ = 0;
};

/// The kinds of objects.
/// @{
using Buffer = Object<&Functions::DeleteBuffers>;
using Image2d = Object<&Functions::DeleteTextures>;
using Framebuffer = Object<&Functions::DeleteFramebuffers>;
using VertexArray = Object<&Functions::DeleteVertexArrays>;
using Query = Object<&Functions::DeleteQueries>;
using Program = Object<&Functions::DeleteProgram>;
/// @}

/// A buffer of `bytes` bytes. `flags`: of glNamedBufferStorage(). `data`: its contents, or nullptr.
Buffer make_buffer(Context& context, std::size_t bytes, GLbitfield flags,
                   const void* data = nullptr);
/// A two-dimensional texture with one level. `format`: e.g. GL_R8UI.
Image2d make_image(Context& context, GLenum format, int width, int height);
/// Vertex arrays and framebuffers without contents.
/// @{
VertexArray make_vertex_array(Context& context);
Framebuffer make_framebuffer(Context& context);
/// @}

/// A buffer whose memory is mapped all the time.
struct MappedBuffer {
  /// No buffer.
  MappedBuffer() = default;
  /// `access`: GL_MAP_READ_BIT or GL_MAP_WRITE_BIT.
  MappedBuffer(Context& context, std::size_t bytes, GLbitfield access);

  Buffer buffer;              ///< the buffer
  std::byte* data = nullptr;  ///< its memory; nullptr if the context is lost
};

/// Waits until the GPU has executed the commands before `fence`, and deletes it. A GPU that does
/// not answer in time is lost: 0.25 s; a software renderer has 20 s.
void wait(Context& context, GLsync fence);

}  // namespace handcast::renderer::gl
