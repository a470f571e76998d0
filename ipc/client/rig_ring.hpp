// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/shm/segment.hpp"

namespace handcast::client {

/// A ring of a rig that is up, mapped read-only unless a tool may write to it (msg::kTestPictures,
/// those of msg::is_for_guests()).
struct RigRing {
  std::string rig;       ///< name of the rig
  ipc::Segment segment;  ///< the memory of the ring
};

/// Requests the ring of a stream from a rig. An empty name means the only rig that is up. Waits for
/// the answer at most `patience`. Errors: unavailable (no such rig is up, it does not answer, or
/// there is no memory to map the ring), bad_config (no stream of this name;
/// the sentence names those that there are), bad_data (the answer or the ring is unusable, e.g. of
/// another version).
Result<RigRing> rig_ring(const std::string& rig, std::string_view stream,
                         std::chrono::nanoseconds patience = std::chrono::seconds(2));

/// The names of all streams of a rig. Errors: as rig_ring(), without bad_config.
Result<std::vector<std::string>> stream_names(
    const std::string& rig, std::chrono::nanoseconds patience = std::chrono::seconds(2));

}  // namespace handcast::client
