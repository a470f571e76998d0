// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::desk {

/// Where a cue list stands.
struct CuePosition {
  std::uint64_t revision = 0;          ///< increases with every change
  std::vector<std::string> names;      ///< of all cues, in their order
  std::optional<std::size_t> current;  ///< the cue that was last gone to; empty: none yet
  bool held = false;                   ///< its fades stand still
  std::string fault;                   ///< what went wrong at the last cue; empty if nothing did
};

/// The cue list of a rig, for surfaces that show and work it. All functions may be called by any
/// thread; none blocks for longer than 2 s. Errors: bad_config (there is no such cue), unavailable.
class CueDeck {
 public:
  virtual ~CueDeck() = default;
  /// Where it stands now.
  virtual CuePosition position() const = 0;
  /// The next cue; the one before; the one at an index.
  /// @{
  virtual Result<void> go(std::string_view source) = 0;
  virtual Result<void> back(std::string_view source) = 0;
  virtual Result<void> jump(std::size_t index, std::string_view source) = 0;
  /// @}
  /// Stops the fades of the current cue where they are; again: lets them go on.
  virtual Result<void> hold(std::string_view source) = 0;
};

}  // namespace handcast::desk
