// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/gl/upload_ring.hpp"

#include <algorithm>
#include <utility>

namespace handcast::renderer::gl {

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

}  // namespace handcast::renderer::gl
