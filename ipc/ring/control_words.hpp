// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "ipc/ring/real_atomics.hpp"
#include "ipc/ring/words.hpp"
#include "ipc/shm/segment.hpp"

namespace handcast::ipc {

/// The control words of a mapped segment; valid as long as it is mapped.
inline ControlWords<RealAtomics> control_words_of(const Segment& segment) {
  auto* lines = reinterpret_cast<ControlWords<RealAtomics>::Line*>(segment.data() + kControlOffset);
  return {lines, segment.slots(), segment.keep_history()};
}

}  // namespace handcast::ipc
