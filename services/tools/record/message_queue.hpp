// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <variant>

#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "ipc/msg/projection.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "ipc/ring/reader.hpp"

namespace handcast::record {

/// A message of any stream, in the buffer into which its reader copied it.
using AnySample = std::variant<ipc::Sample<msg::CameraFrame>, ipc::Sample<msg::HandPoses>,
                               ipc::Sample<msg::Landmarks>, ipc::Sample<msg::Projection>,
                               ipc::Sample<msg::StageMarks>>;

/// A message on its way to the disk.
struct Queued {
  std::size_t stream = 0;  ///< index into the streams of the recording
  std::uint64_t lost = 0;  ///< messages between it and the one before that are missing
  AnySample sample;
};

/// What the threads that read rings pass on to the one that writes. Any thread.
class MessageQueue {
 public:
  /// Appends a message.
  void push(Queued message);
  /// The oldest message; waits for one. Empty when the queue is closed and has no more.
  std::optional<Queued> pop();
  /// No message follows.
  void close();

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Queued> messages_;
  bool closed_ = false;
};

}  // namespace handcast::record
