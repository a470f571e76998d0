// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "ipc/msg/projection.hpp"
#include "renderer/pipeline/pipeline.hpp"

namespace handcast::renderer {

/// Writes a finished frame as the message that observers read: its times, origins and vertices, and
/// the pixels of its region into the tail, and what they show if the frame has it. `tail_bytes`:
/// the space after the struct; a region that does not fit is left out. The caller sets
/// header.frame_id and lit_ns.
void write_projection(const Frame& frame, msg::Projection& projection, std::size_t tail_bytes);

}  // namespace handcast::renderer
