// SPDX-License-Identifier: Apache-2.0
// The part of handcast.h that reads the images and hands of a rig and sends hands and landmarks.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/client/c_calls.hpp"
#include "ipc/client/stream.hpp"
#include "ipc/control/choose_rig.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/check_guest.hpp"
#include "ipc/msg/guest_streams.hpp"
#include "ipc/ring/writer.hpp"

using handcast::Deadline;
using handcast::Errc;
using handcast::fail;
using handcast::Result;
using namespace handcast::msg;

namespace {

/// Nothing comes back from the rig, so it is asked so often whether it is still up.
constexpr std::int64_t kAskEvery_ns = 3'000'000'000;

/// The way of messages of one type to the rig. Opened with the first one.
template <class T>
struct Outbox {
  std::string_view stream;
  std::optional<handcast::ipc::Writer<T>> writer{};
  std::optional<handcast::client::RigPresence> presence{};
  std::int64_t last_ns = 0;

  Result<void> open(const std::string& rig) {
    auto ring = handcast::client::rig_ring(rig, stream);
    if (!ring) return tl::make_unexpected(ring.error());
    presence.emplace(ring->rig, std::string(stream), ring->segment.created_ns(),
                     handcast::client::PresenceTimes{.silence_ns = kAskEvery_ns});
    auto attached = handcast::ipc::Writer<T>::attach(std::move(ring->segment));
    if (!attached)
      return handcast::fail_in("another program sends or draws there already; end it first",
                               attached.error());
    writer.emplace(std::move(*attached));
    return {};
  }

  /// Checks a message, and opens the way if it is not open.
  Result<void> prepare(const std::string& rig, const T& message) {
    const auto time_ns = handcast::now_ns();
    if (auto time = check_guest_time(message.header.origin_ns, last_ns, time_ns); !time)
      return time;
    if (auto fits = check_guest(message); !fits) return fits;
    return writer ? Result<void>() : open(rig);
  }
  /// What to send is a message, or a loan of a prepared one.
  template <class Sent>
  Result<void> send(std::int64_t origin_ns, Sent&& sent) {
    last_ns = origin_ns;
    writer->publish(std::forward<Sent>(sent));
    return presence->silent();
  }
};

/// A stream that is read. Opened with the first read.
template <class T>
struct Inbox {
  std::string_view name;
  std::optional<handcast::client::Stream<T>> stream{};
  std::optional<handcast::ipc::Sample<T>> newest{};

  Result<void> wait(const std::string& rig, Deadline deadline) {
    if (!stream) {
      auto opened = handcast::client::open_stream<T>(rig, name);
      if (!opened) return tl::make_unexpected(opened.error());
      stream.emplace(std::move(*opened));
    }
    auto sample = stream->latest(deadline);
    if (!sample) return tl::make_unexpected(sample.error());
    newest.emplace(std::move(*sample));
    return {};
  }
};

}  // namespace

/// What a handle stands for.
struct handcast_rig {
  std::string name;
  Inbox<CameraFrame> images{"camera.frames"};
  Inbox<HandPoses> hands{"pose.hands"};
  std::array<Outbox<CameraFrame>, 2> pictures{{{kGuestImages}, {kSecondGuestImages}}};
  std::array<Outbox<HandPoses>, 1> poses{{{kGuestPoses}}};
  std::array<Outbox<Landmarks>, 2> landmarks{{{kGuestLandmarks}, {kSecondGuestLandmarks}}};
  std::uint64_t samples = 0;  ///< of hands that were sent
};

namespace {

static_assert(HANDCAST_LANDMARKS == kLandmarks);
static_assert(sizeof(handcast_point) == sizeof(Landmark));

template <class Work>
handcast_result with(handcast_rig* rig, const char* function, const Work& work) {
  return handcast::client::with(rig, function, "handcast_rig_open", "handcast_rig_close", work);
}

tl::unexpected<handcast::Error> missing(const char* function, const char* argument) {
  return fail(Errc::bad_config, fmt::format("{}: `{}` is NULL", function, argument));
}

Result<Deadline> deadline_in(const char* function, int timeout_ms) {
  constexpr int kLongest_ms = 10'000;
  if (timeout_ms >= 0 && timeout_ms <= kLongest_ms)
    return timeout_ms == 0 ? Deadline::now() : Deadline::in(std::chrono::milliseconds(timeout_ms));
  return fail(Errc::bad_config,
              fmt::format("{}: {} ms is outside 0 to {}", function, timeout_ms, kLongest_ms));
}

HandPoses message_of(const handcast_both_hands& hands) {
  HandPoses poses;
  poses.header.origin_ns = hands.time_ns;
  for (std::size_t side = 0; side < kMaxHands; ++side) {
    if (!hands.is_there[side]) continue;
    auto& pose = poses.hands[poses.count++];
    pose.side = static_cast<Side>(side);
    pose.confidence = 1;
    std::memcpy(pose.joints.data(), hands.joints[side], sizeof hands.joints[side]);
  }
  return poses;
}

/// Without its pixels.
CameraFrame message_of(const handcast_image& image) {
  CameraFrame frame;
  frame.header = {image.number, image.time_ns, 0};
  frame.width_px = static_cast<std::uint32_t>(std::max(image.width, 0));
  frame.height_px = static_cast<std::uint32_t>(std::max(image.height, 0));
  return frame;
}

Landmarks message_of(const handcast_landmarks& found) {
  Landmarks landmarks;
  landmarks.header = {found.image, found.time_ns, 0};
  for (std::size_t side = 0; side < kMaxHands; ++side) {
    if (found.presence[side] == 0) continue;
    auto& hand = landmarks.hands[landmarks.count++];
    hand.side = static_cast<Side>(side);
    hand.presence = found.presence[side];
    std::memcpy(hand.points.data(), found.points[side], sizeof found.points[side]);
  }
  return landmarks;
}

handcast_image image_of(const CameraFrame& frame) {
  return {frame.pixels(),
          static_cast<int32_t>(frame.width_px),
          static_cast<int32_t>(frame.height_px),
          frame.header.frame_id,
          frame.header.origin_ns,
          0};
}

/// handcast_wait_image() and handcast_wait_hands(), whose `result` has the name `argument`.
template <class T, class Read, class ResultOf>
handcast_result wait_for(handcast_rig* rig, Inbox<T> handcast_rig::*box, const char* function,
                         const char* argument, Read* result, int timeout_ms,
                         const ResultOf& result_of) {
  if (result) *result = {};
  return with(rig, function, [&]() -> Result<void> {
    if (!result) return missing(function, argument);
    const auto deadline = deadline_in(function, timeout_ms);
    if (!deadline) return tl::make_unexpected(deadline.error());
    Inbox<T>& inbox = rig->*box;
    if (auto come = inbox.wait(rig->name, *deadline); !come) return come;
    *result = result_of(**inbox.newest);
    return {};
  });
}

std::size_t camera_of(const handcast_both_hands&) { return 0; }
std::size_t camera_of(const auto& sent) { return static_cast<std::size_t>(sent.camera); }

/// The way of what is of a camera: 0 the first one, 1 the second.
template <class Boxes>
Result<typename Boxes::value_type*> outbox(Boxes& boxes, const char* function, std::size_t camera) {
  if (camera < boxes.size()) return &boxes[camera];
  return fail(Errc::bad_config, fmt::format("{}: `camera` is neither 0 nor 1", function));
}

/// handcast_send_hands() and handcast_send_landmarks(), whose `sent` has the name `argument`.
template <class Boxes, class Sent>
handcast_result send(handcast_rig* rig, Boxes handcast_rig::*boxes, const char* function,
                     const char* argument, const Sent* sent) {
  return with(rig, function, [&]() -> Result<void> {
    if (!sent) return missing(function, argument);
    const auto box = outbox(rig->*boxes, function, camera_of(*sent));
    if (!box) return tl::make_unexpected(box.error());
    auto message = message_of(*sent);
    if constexpr (std::is_same_v<Sent, handcast_both_hands>)
      message.header.frame_id = ++rig->samples;
    if (auto ready = (*box)->prepare(rig->name, message); !ready) return ready;
    return (*box)->send(message.header.origin_ns, message);
  });
}

}  // namespace

int handcast_abi() { return HANDCAST_ABI; }

int64_t handcast_now() { return handcast::now_ns(); }

handcast_result handcast_rig_open(const char* name, handcast_rig** rig) {
  return handcast::client::guarded([&]() -> Result<void> {
    if (!rig) return missing("handcast_rig_open", "rig");
    *rig = nullptr;
    const auto chosen = handcast::control::choose_rig(name ? name : "");
    if (!chosen) return tl::make_unexpected(chosen.error());
    auto opened = std::make_unique<handcast_rig>();
    opened->name = *chosen;
    *rig = handcast::client::Handles<handcast_rig>::add(std::move(opened));
    return {};
  });
}

handcast_result handcast_wait_image(handcast_rig* rig, handcast_image* image, int timeout_ms) {
  return wait_for(rig, &handcast_rig::images, "handcast_wait_image", "image", image, timeout_ms,
                  image_of);
}

handcast_result handcast_wait_hands(handcast_rig* rig, handcast_both_hands* hands, int timeout_ms) {
  return wait_for(rig, &handcast_rig::hands, "handcast_wait_hands", "hands", hands, timeout_ms,
                  handcast::client::both_hands);
}

handcast_result handcast_send_hands(handcast_rig* rig, const handcast_both_hands* hands) {
  return send(rig, &handcast_rig::poses, "handcast_send_hands", "hands", hands);
}

handcast_result handcast_send_landmarks(handcast_rig* rig, const handcast_landmarks* landmarks) {
  return send(rig, &handcast_rig::landmarks, "handcast_send_landmarks", "landmarks", landmarks);
}

handcast_result handcast_send_image(handcast_rig* rig, const handcast_image* image) {
  return with(rig, "handcast_send_image", [&]() -> Result<void> {
    if (!image || !image->pixels) return missing("handcast_send_image", "image");
    const auto box = outbox(rig->pictures, "handcast_send_image", camera_of(*image));
    if (!box) return tl::make_unexpected(box.error());
    const auto head = message_of(*image);
    if (auto ready = (*box)->prepare(rig->name, head); !ready) return ready;
    auto loan = (*box)->writer->loan();
    if (!loan) return fail(Errc::timeout, "handcast_send_image: the rig still reads the last ones");
    if (head.used_bytes() > sizeof(CameraFrame) + loan.tail_bytes())
      return fail(Errc::bad_data,
                  fmt::format("an image of {}x{} px does not fit into the rig's ring", image->width,
                              image->height));
    *loan = head;
    std::memcpy(loan->pixels(), image->pixels, head.used_bytes() - sizeof(CameraFrame));
    return (*box)->send(head.header.origin_ns, std::move(loan));
  });
}

void handcast_rig_close(handcast_rig* rig) {
  if (!rig) return;
  with(rig, "handcast_rig_close", [&]() -> Result<void> {
    handcast::client::Handles<handcast_rig>::remove(rig);
    return {};
  });
}
