// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "ipc/base/result.hpp"
#include "renderer/kms/atomic.hpp"
#include "renderer/kms/buffer.hpp"
#include "renderer/kms/display.hpp"

namespace handcast::renderer::kms {

/// The parts of a card through which a picture gets to a display, with the properties they had when
/// they were found.
struct Pipe {
  Object connector, crtc, plane;
  std::vector<Object> other_planes;  ///< shown by the CRTC on top of the picture, as the cursor
  PixelOrder order = PixelOrder::blue_first;  ///< red_first if the plane has it
};

/// Finds the parts for a display: those it uses now, or ones that no other display uses. Errors:
/// unavailable (all are in use).
Result<Pipe> find_pipe(int card, const Display& display);

/// The former state of a pipe. Destroyed before the card is closed.
class Former {
 public:
  Former() = default;
  /// Keeps the state that the pipe was found in.
  Former(int card, const Pipe& pipe);
  /// Brings the card back into this state. Returns 0 or an errno.
  int restore(int card) const;

 private:
  struct Value {
    Object object;
    std::string_view name;
    std::uint64_t value = 0;
  };
  std::vector<Value> values_;
  std::vector<Blob> blobs_;
};

}  // namespace handcast::renderer::kms
