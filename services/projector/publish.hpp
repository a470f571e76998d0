// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "ipc/msg/projection.hpp"
#include "ipc/ring/writer.hpp"
#include "renderer/pipeline/pipeline.hpp"
#include "services/projector/projector.hpp"

namespace handcast::projector {

/// Writes what was projected into a message with room for `tail_bytes` of pixels behind it. A
/// region that does not fit is left out.
/// `frame_id`: the projector's own number of the frame.
void write_projection(const renderer::Frame& frame, std::uint64_t frame_id,
                      const PresentTimes& times, msg::Projection& projection,
                      std::size_t tail_bytes);

/// The same into the next slot of the ring; nothing where readers hold all of them.
void publish_projection(const renderer::Frame& frame, std::uint64_t frame_id,
                        const PresentTimes& times, ipc::Writer<msg::Projection>& projections);

}  // namespace handcast::projector
