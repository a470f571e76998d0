// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <variant>

#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/client/stream.hpp"
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

/// How a feed works.
struct FeedSettings {
  std::size_t stream = 0;      ///< index of its stream in the recording
  std::size_t most_bytes = 0;  ///< limit of the memory of messages that are not written yet
  std::int64_t begin_ns = 0;   ///< messages that were published before are left out
};

/// One ring of a rig as a source of messages. read() is called by one thread, written() by another.
class Feed {
 public:
  virtual ~Feed() = default;

  /// Passes the messages that have come on to the queue; waits for the first one until the
  /// deadline. A message for which there is no room in the memory of the feed is lost. Errors:
  /// disconnected (the rig is down).
  virtual Result<void> read(MessageQueue& queue, Deadline deadline) = 0;

  /// A message of this feed that was taken from the queue takes no more memory.
  void written(std::size_t bytes) { held_bytes_ -= bytes; }
  /// Messages that were lost since the last one that was passed on. Call it when read() is no
  /// longer called.
  std::uint64_t lost() const { return lost_; }
  /// True for a ring of few slots, whose messages must be fetched soon.
  bool is_hasty() const { return hasty_; }

 protected:
  Feed(bool hasty, const FeedSettings& settings) : hasty_(hasty), settings_(settings) {}

  bool hasty_;
  FeedSettings settings_;
  std::uint64_t lost_ = 0;
  std::atomic<std::size_t> held_bytes_{0};
};

/// Size in memory of a message in the queue.
std::size_t bytes_of(const AnySample& sample);

/// The feed of a ring, for all types of AnySample.
template <class T>
std::unique_ptr<Feed> feed_of(client::Stream<T> ring, const FeedSettings& settings);

/// Opens the ring of a rig. Errors: as client::open_stream().
Result<std::unique_ptr<Feed>> open_feed(const std::string& rig, const std::string& name,
                                        const FeedSettings& settings);

}  // namespace handcast::record
