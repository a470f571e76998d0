// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::client {

/// The times by which a reader tells a rig that is silent from one that is down.
struct PresenceTimes {
  std::int64_t silence_ns = 1'000'000'000;  ///< silence before the rig is asked, and between two
  std::int64_t absence_ns = 2'000'000'000;  ///< a supervisor that died is replaced within this time
};

/// Whether the rig that a ring belongs to is still up. It is asked only while the ring is silent,
/// so a reader goes on while a supervisor is replaced. One thread.
class RigPresence {
 public:
  /// `ring_created_ns`: Segment::created_ns() of the ring of `stream`, which tells the rings of
  /// successive rigs of one name apart.
  RigPresence(std::string rig, std::string stream, std::int64_t ring_created_ns,
              PresenceTimes times = {});

  /// A message has come.
  void heard();
  /// No message has come. Asks the rig if the silence lasts, which takes 100 ms if its supervisor
  /// hangs. Errors: disconnected (the rig is down, or another one of this name is up).
  Result<void> silent();

 private:
  Result<void> absent(std::int64_t now_ns);
  Result<void> same_ring() const;

  std::string rig_;
  std::string stream_;
  std::int64_t ring_created_ns_;
  PresenceTimes times_;
  std::int64_t next_check_ns_;
  std::int64_t absent_since_ns_ = 0;  ///< 0: a supervisor was there at the last check
};

}  // namespace handcast::client
