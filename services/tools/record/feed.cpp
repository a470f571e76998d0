// SPDX-License-Identifier: Apache-2.0
#include "services/tools/record/feed.hpp"

#include <fmt/format.h>

#include <optional>
#include <type_traits>
#include <utility>

#include "services/recording/streams.hpp"

namespace handcast::record {

void MessageQueue::push(Queued message) {
  {
    const std::lock_guard lock(mutex_);
    messages_.push_back(std::move(message));
  }
  changed_.notify_one();
}

std::optional<Queued> MessageQueue::pop() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return closed_ || !messages_.empty(); });
  if (messages_.empty()) return std::nullopt;
  auto message = std::move(messages_.front());
  messages_.pop_front();
  return message;
}

void MessageQueue::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
}

namespace {

template <class T>
std::size_t size_of(const T& message) {
  if constexpr (ipc::HasTail<T>)
    return message.used_bytes();
  else
    return sizeof(T);
}

template <class T>
class RingFeed final : public Feed {
 public:
  RingFeed(client::Stream<T> ring, const FeedSettings& settings)
      : Feed(ipc::HasTail<T>, settings), ring_(std::move(ring)) {}

  Result<void> read(MessageQueue& queue, Deadline deadline) override {
    for (auto until = deadline;; until = Deadline::now()) {
      auto sample = ring_.next(until);
      if (sample && !is_of_this_rig(**sample))
        return fail(Errc::disconnected,
                    "the rig was given another calibration; what follows is for another recording");
      if (sample) {
        take(std::move(*sample), queue);
        continue;
      }
      if (sample.error().code == Errc::disconnected)
        return tl::make_unexpected(std::move(sample.error()));
      if (sample.error().code == Errc::timeout) return {};
      // Unusable messages are in skipped().
      if (sample.error().code == Errc::unavailable) ++lost_;
    }
  }

 private:
  /// A recording has one calibration, which its images know.
  bool is_of_this_rig(const T& message) {
    if constexpr (std::is_same_v<T, msg::CameraFrame>) {
      if (!calibration_) calibration_ = message.calibration;
      return message.calibration == *calibration_;
    }
    return true;
  }
  void take(ipc::Sample<T> sample, MessageQueue& queue) {
    const auto skipped = ring_.reader().skipped();
    lost_ += skipped - std::exchange(skipped_, skipped);
    if (sample->header.published_ns < settings_.begin_ns) {
      lost_ = 0;  // what is missing so far is not of this recording either
      return;
    }
    const auto bytes = size_of(*sample);
    if (held_bytes_ + bytes > settings_.most_bytes) {
      ++lost_;
      return;
    }
    held_bytes_ += bytes;
    queue.push({settings_.stream, std::exchange(lost_, 0u), std::move(sample)});
  }

  client::Stream<T> ring_;
  std::uint64_t skipped_ = 0;
  std::optional<std::uint32_t> calibration_;  ///< of the first image
};

template <class T>
Result<std::unique_ptr<Feed>> open_as(const std::string& rig, const std::string& name,
                                      const FeedSettings& settings) {
  auto ring = client::open_stream<T>(rig, name);
  if (!ring) return tl::make_unexpected(std::move(ring.error()));
  return feed_of(std::move(*ring), settings);
}

}  // namespace

template <class T>
std::unique_ptr<Feed> feed_of(client::Stream<T> ring, const FeedSettings& settings) {
  return std::make_unique<RingFeed<T>>(std::move(ring), settings);
}
template std::unique_ptr<Feed> feed_of(client::Stream<msg::CameraFrame>, const FeedSettings&);
template std::unique_ptr<Feed> feed_of(client::Stream<msg::HandPoses>, const FeedSettings&);
template std::unique_ptr<Feed> feed_of(client::Stream<msg::Landmarks>, const FeedSettings&);
template std::unique_ptr<Feed> feed_of(client::Stream<msg::Projection>, const FeedSettings&);
template std::unique_ptr<Feed> feed_of(client::Stream<msg::StageMarks>, const FeedSettings&);

std::size_t bytes_of(const AnySample& sample) {
  return std::visit([](const auto& each) { return size_of(*each); }, sample);
}

Result<std::unique_ptr<Feed>> open_feed(const std::string& rig, const std::string& name,
                                        const FeedSettings& settings) {
  using recording::type_of;
  const auto* type = recording::type_of_stream(name);
  if (type == &type_of<msg::CameraFrame>()) return open_as<msg::CameraFrame>(rig, name, settings);
  if (type == &type_of<msg::HandPoses>()) return open_as<msg::HandPoses>(rig, name, settings);
  if (type == &type_of<msg::Landmarks>()) return open_as<msg::Landmarks>(rig, name, settings);
  if (type == &type_of<msg::Projection>()) return open_as<msg::Projection>(rig, name, settings);
  if (type == &type_of<msg::StageMarks>()) return open_as<msg::StageMarks>(rig, name, settings);
  return fail(Errc::bad_config, fmt::format("the messages of ring '{}' are unknown", name));
}

}  // namespace handcast::record
