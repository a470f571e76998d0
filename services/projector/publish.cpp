// SPDX-License-Identifier: Apache-2.0
#include "services/projector/publish.hpp"

#include "renderer/pipeline/projection.hpp"

namespace handcast::projector {

void write_projection(const renderer::Frame& frame, std::uint64_t frame_id,
                      const PresentTimes& times, msg::Projection& projection,
                      std::size_t tail_bytes) {
  renderer::write_projection(frame, projection, tail_bytes);
  projection.header.frame_id = frame_id;
  projection.lit_ns = times.display_ns;
}

void publish_projection(const renderer::Frame& frame, std::uint64_t frame_id,
                        const PresentTimes& times, ipc::Writer<msg::Projection>& projections) {
  auto slot = projections.loan();
  if (!slot) return;
  write_projection(frame, frame_id, times, *slot, slot.tail_bytes());
  projections.publish(std::move(slot));
}

}  // namespace handcast::projector
