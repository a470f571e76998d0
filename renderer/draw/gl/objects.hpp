// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <string_view>
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

/// Memory for the data of a pass, which the GPU reads while the processor already writes the next
/// one: a mapped buffer with three slots. It grows when a pass needs more.
class UploadRing {
 public:
  /// Without memory until the first next().
  explicit UploadRing(Context& context) : context_(context) {}
  ~UploadRing();
  UploadRing(const UploadRing&) = delete;
  UploadRing& operator=(const UploadRing&) = delete;

  /// A slot of at least `bytes` bytes; waits until the GPU has read it. nullptr if the context is
  /// lost.
  std::byte* next(std::size_t bytes);
  /// Marks the slot as in use by the commands that were issued so far.
  void sent();
  /// The buffer, and the offset of the slot in it.
  /// @{
  GLuint buffer() const { return mapped_.buffer.name(); }
  std::size_t offset() const { return slot_ * slot_bytes_; }
  /// @}
  /// Where the byte `place` of the slot is in the bound buffer, as OpenGL takes it.
  const void* pointer(std::size_t place = 0) const {
    return reinterpret_cast<const void*>(offset() + place);  // NOLINT(performance-no-int-to-ptr)
  }

 private:
  static constexpr std::size_t kSlots = 3;

  void release_slots();

  Context& context_;
  MappedBuffer mapped_;
  std::size_t slot_bytes_ = 0, slot_ = 0;
  std::array<GLsync, kSlots> in_use_{};
};

/// What the GPU does for one frame, in the order of msg::Stage from gpu_draw on.
enum class Pass { draw, warp, upload, fill, read };
/// The names of the passes.
constexpr std::array<std::string_view, 5> kPassNames{"draw", "warp", "upload", "fill", "read"};

/// The time of each pass on the GPU, in µs; 0 for a pass that was not done.
using PassTimes = std::array<double, kPassNames.size()>;

/// Measures the passes of a frame by timer queries of the GPU.
class PassTimer {
 public:
  /// If it is not `on`, it does nothing.
  PassTimer(Context& context, bool on);

  /// Issues commands as one pass.
  template <class Commands>
  void measure(Pass pass, Commands&& commands) {
    begin(pass);
    commands();
    end(pass);
  }
  /// The passes since the last call. Waits until the GPU has finished them.
  PassTimes take();

 private:
  void begin(Pass pass);
  void end(Pass pass);

  Context& context_;
  std::array<Query, kPassNames.size()> queries_;
  std::array<bool, kPassNames.size()> used_{};
  bool on_;
};

}  // namespace handcast::renderer::gl
