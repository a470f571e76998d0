// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "ipc/shm/segment.hpp"
#include "services/recording/recording_writer.hpp"

namespace handcast::watch {

/// Messages that were taken from a ring, to be written. Any one thread.
class Kept {
 public:
  virtual ~Kept() = default;
  /// Writes all to a stream of a recording. Errors: those of RecordingWriter::append().
  virtual Result<void> write(recording::RecordingWriter& writer, std::size_t stream) const = 0;
  /// Number of messages.
  virtual std::size_t count() const = 0;
};

/// One ring of a rig, and its messages of the last seconds. It takes no place in the ring. One
/// thread.
class Track {
 public:
  virtual ~Track() = default;
  /// Takes the new messages, and forgets those that were published before `since_ns`.
  virtual void take(std::int64_t since_ns) = 0;
  /// Gives away what it holds, and goes on without it.
  virtual std::unique_ptr<Kept> give() = 0;
};

/// Is told of each message of a ring; empty: nobody is.
/// @{
using OnPoses = std::function<void(const msg::HandPoses&)>;
using OnMarks = std::function<void(const msg::StageMarks&)>;
/// @}

/// Errors: bad_data (the ring has other messages), those of ipc::Reader::watch().
/// @{
Result<std::unique_ptr<Track>> track_poses(ipc::Segment ring, OnPoses on_message);
Result<std::unique_ptr<Track>> track_landmarks(ipc::Segment ring);
Result<std::unique_ptr<Track>> track_marks(ipc::Segment ring, OnMarks on_message);
/// Five images a second, at most 256 MB.
Result<std::unique_ptr<Track>> track_images(ipc::Segment ring);
/// @}

}  // namespace handcast::watch
