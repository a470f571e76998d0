// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>

#include "renderer/draw/gl/objects.hpp"

namespace handcast::renderer::gl {

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

}  // namespace handcast::renderer::gl
