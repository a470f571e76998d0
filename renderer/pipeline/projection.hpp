// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "ipc/msg/projection.hpp"
#include "renderer/pipeline/pipeline.hpp"

namespace handcast::renderer {

/// Writes a finished frame as the message that observers read: the pixels of its lit region into
/// the tail, its landings, its times and origins. `tail_bytes` is the room after the struct; a
/// region that does not fit is left out. header.frame_id and lit_ns are the caller's to set.
void write_projection(const Frame& frame, msg::Projection& projection, std::size_t tail_bytes);

}  // namespace handcast::renderer
