// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "renderer/filter/filters.hpp"

namespace handcast::renderer {

/// A detector may take one finger for another for a while. Where two fingers' landmarks lie on each
/// other's places they are exchanged back; a detector that goes on saying so is believed in the
/// end.
class FingerOrder {
 public:
  /// `expected`: where the landmarks should have been at `origin_ns`; unknown ones are not judged.
  msg::HandLandmarks mended(std::int64_t origin_ns, const msg::HandLandmarks& seen,
                            const ExpectedPoints& expected);

 private:
  std::optional<std::int64_t> wrong_since_ns_;
};

}  // namespace handcast::renderer
