// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "ipc/msg/projection.hpp"
#include "ipc/ring/writer.hpp"
#include "renderer/pipeline/pipeline.hpp"
#include "services/projector/projector.hpp"

namespace handcast::projector {

/// Writes a projected frame to a message that is followed by `tail_bytes` for pixels. A region that
/// does not fit is left out. `frame_id` is counted by the projector.
void write_projection(const renderer::Frame& frame, std::uint64_t frame_id,
                      const PresentTimes& times, msg::Projection& projection,
                      std::size_t tail_bytes);

/// Publishes a projected frame; drops it if readers hold all slots of the ring.
void publish_projection(const renderer::Frame& frame, std::uint64_t frame_id,
                        const PresentTimes& times, ipc::Writer<msg::Projection>& projections);

}  // namespace handcast::projector
