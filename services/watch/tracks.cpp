// SPDX-License-Identifier: Apache-2.0
#include "services/watch/tracks.hpp"

#include <cstring>
#include <deque>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/landmarks.hpp"
#include "ipc/msg/owned.hpp"
#include "ipc/ring/reader.hpp"

namespace handcast::watch {
namespace {

constexpr std::size_t kMostAtOnce = 1000;  ///< messages of a ring in one turn
constexpr std::int64_t kImageEvery_ns = 200'000'000;
constexpr std::size_t kMostImageBytes = std::size_t{256} << 20;

/// A message, where it was in its ring, and how many are missing before it.
template <class T>
struct KeptMessage {
  msg::Owned<T> message;
  std::uint64_t sequence = 0, lost = 0;
};

template <class T>
std::size_t bytes_of(const T& message) {
  if constexpr (ipc::HasTail<T>)
    return message.used_bytes();
  else
    return sizeof message;
}

template <class T>
class KeptMessages final : public Kept {
 public:
  explicit KeptMessages(std::deque<KeptMessage<T>> messages) : messages_(std::move(messages)) {}

  Result<void> write(recording::RecordingWriter& writer, std::size_t stream) const override {
    for (const auto& each : messages_)
      if (auto done = writer.append(stream, *each.message, each.sequence, each.lost); !done)
        return done;
    return {};
  }
  std::size_t count() const override { return messages_.size(); }

 private:
  std::deque<KeptMessage<T>> messages_;
};

template <class T>
class RingTrack final : public Track {
 public:
  RingTrack(ipc::Reader<T> reader, std::function<void(const T&)> on_message)
      : reader_(std::move(reader)), on_message_(std::move(on_message)) {}

  void take(std::int64_t since_ns) override {
    for (std::size_t i = 0; i < kMostAtOnce && reader_.await(Deadline::now()); ++i) {
      const auto sample =
          ipc::HasTail<T> ? reader_.latest(Deadline::now()) : reader_.next(Deadline::now());
      if (!sample) break;
      if (on_message_) on_message_(**sample);
      keep(*sample);
    }
    while (!messages_.empty() && (messages_.front().message->header.published_ns < since_ns ||
                                  bytes_ > kMostImageBytes)) {
      bytes_ -= bytes_of(*messages_.front().message);
      messages_.pop_front();
    }
  }

  std::unique_ptr<Kept> give() override {
    bytes_ = 0;
    return std::make_unique<KeptMessages<T>>(std::exchange(messages_, {}));
  }

 private:
  void keep(const ipc::Sample<T>& sample) {
    const auto published_ns = sample->header.published_ns;
    if (ipc::HasTail<T> && !messages_.empty() &&
        published_ns < messages_.back().message->header.published_ns + kImageEvery_ns)
      return;
    const auto bytes = bytes_of(*sample);
    msg::Owned<T> copy(bytes);
    std::memcpy(static_cast<void*>(&*copy), &*sample, bytes);
    const auto gap = messages_.empty() ? 1 : sample.sequence() - messages_.back().sequence;
    messages_.push_back({std::move(copy), sample.sequence(), gap - 1});
    bytes_ += bytes;
  }

  ipc::Reader<T> reader_;
  std::function<void(const T&)> on_message_;
  std::deque<KeptMessage<T>> messages_;
  std::size_t bytes_ = 0;
};

template <class T>
Result<std::unique_ptr<Track>> track(ipc::Segment ring, std::function<void(const T&)> on_message) {
  auto reader = ipc::Reader<T>::watch(std::move(ring));
  if (!reader) return tl::make_unexpected(reader.error());
  return std::make_unique<RingTrack<T>>(std::move(*reader), std::move(on_message));
}

}  // namespace

Result<std::unique_ptr<Track>> track_poses(ipc::Segment ring, OnPoses on_message) {
  return track<msg::HandPoses>(std::move(ring), std::move(on_message));
}
Result<std::unique_ptr<Track>> track_landmarks(ipc::Segment ring) {
  return track<msg::Landmarks>(std::move(ring), {});
}
Result<std::unique_ptr<Track>> track_marks(ipc::Segment ring, OnMarks on_message) {
  return track<msg::StageMarks>(std::move(ring), std::move(on_message));
}
Result<std::unique_ptr<Track>> track_images(ipc::Segment ring) {
  return track<msg::CameraFrame>(std::move(ring), {});
}

}  // namespace handcast::watch
