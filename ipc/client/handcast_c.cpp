// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstring>
#include <memory>
#include <optional>
#include <string>

#include "ipc/base/clock.hpp"
#include "ipc/base/version.hpp"
#include "ipc/client/c_calls.hpp"
#include "ipc/client/handcast.h"
#include "ipc/client/stream.hpp"
#include "ipc/msg/guest_picture.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/ring/writer.hpp"

using handcast::Errc;
using handcast::fail;
using handcast::Result;
using handcast::msg::GuestPicture;
using handcast::msg::HandPoses;

/// What a handle stands for.
struct handcast_content {
  handcast::ipc::Writer<GuestPicture> writer;
  handcast::client::Stream<HandPoses> poses;
  std::size_t payload_bytes;  ///< of the ring
  int width = 0, height = 0;
  bool is_straight = false;
  std::int64_t lasts_ns = 0;
  std::optional<handcast::ipc::Loan<GuestPicture>> loan{};  ///< destroyed before the writer
  std::optional<HandPoses> newest{};
  std::uint64_t frame = 0;
};

namespace {

static_assert(HANDCAST_LARGEST == GuestPicture::kLargest_px);

/// The same for an open handle.
template <class Work>
handcast_result with(handcast_content* content, const char* function, const Work& work) {
  return handcast::client::with(content, function, "handcast_open", "handcast_close", work);
}

Result<void> check_size(const char* function, int width, int height) {
  constexpr int kLargest_px = HANDCAST_LARGEST;
  if (width >= 1 && height >= 1 && width <= kLargest_px && height <= kLargest_px) return {};
  return fail(Errc::bad_config,
              fmt::format("{}: a picture of {}x{} px is not possible; its size is "
                          "1x1 to {}x{}",
                          function, width, height, kLargest_px, kLargest_px));
}

Result<std::unique_ptr<handcast_content>> open_content(const std::string& rig, int hand, int width,
                                                       int height) {
  const auto stream = handcast::msg::kGuestPictures[static_cast<std::size_t>(hand)];
  auto ring = handcast::client::rig_ring(rig, stream);
  if (!ring) return tl::make_unexpected(ring.error());
  auto poses = handcast::client::open_stream<HandPoses>(ring->rig, "pose.hands");
  if (!poses) return tl::make_unexpected(poses.error());
  const auto payload_bytes = ring->segment.payload_bytes();
  auto writer = handcast::ipc::Writer<GuestPicture>::attach(std::move(ring->segment));
  if (!writer) return handcast::fail_in("handcast_open", writer.error());
  return std::unique_ptr<handcast_content>(
      new handcast_content{std::move(*writer), std::move(*poses), payload_bytes, width, height});
}

/// Errors: bad_data (the rings of the rig are smaller: it is of another version).
Result<void> check_room(const handcast_content& content, int width, int height) {
  if (GuestPicture::bytes(static_cast<std::size_t>(width), static_cast<std::size_t>(height)) <=
      content.payload_bytes)
    return {};
  return fail(Errc::bad_data, fmt::format("a picture of {}x{} px does not fit into the rig's rings",
                                          width, height));
}

/// Takes the newest sample of the tracker, waiting for one that is newer than the last.
Result<void> take_poses(handcast_content& content, handcast::Deadline deadline) {
  const auto sample = content.poses.latest(deadline);
  if (!sample) return tl::make_unexpected(sample.error());
  content.newest = **sample;
  return {};
}

}  // namespace

const char* handcast_version() { return handcast::version().data(); }

const char* handcast_error() { return handcast::client::last_error.c_str(); }

handcast_result handcast_open(const char* rig, int hand, int width, int height,
                              handcast_content** content) {
  return handcast::client::guarded([&]() -> Result<void> {
    if (!content)
      return fail(Errc::bad_config, "handcast_open: `content` is NULL; it takes the result");
    *content = nullptr;
    if (hand != HANDCAST_LEFT && hand != HANDCAST_RIGHT)
      return fail(Errc::bad_config,
                  fmt::format("handcast_open: there is no hand {}; HANDCAST_LEFT is 0, "
                              "HANDCAST_RIGHT 1",
                              hand));
    if (auto fits = check_size("handcast_open", width, height); !fits) return fits;
    auto opened = open_content(rig ? rig : "", hand, width, height);
    if (!opened) return tl::make_unexpected(opened.error());
    if (auto fits = check_room(**opened, width, height); !fits) return fits;
    *content = handcast::client::Handles<handcast_content>::add(std::move(*opened));
    return {};
  });
}

uint8_t* handcast_begin(handcast_content* content) {
  uint8_t* pixels = nullptr;
  with(content, "handcast_begin", [&]() -> Result<void> {
    if (!content->loan) {
      auto loan = content->writer.loan();
      if (!loan)
        return fail(Errc::timeout,
                    "handcast_begin: all pictures are being read; leave this one out");
      loan->width_px = static_cast<std::uint32_t>(content->width);
      loan->height_px = static_cast<std::uint32_t>(content->height);
      std::memset(loan->pixels(), 0, loan->used_bytes() - sizeof(GuestPicture));
      content->loan.emplace(std::move(loan));
    }
    pixels = reinterpret_cast<uint8_t*>((*content->loan)->pixels());
    return {};
  });
  return pixels;
}

handcast_result handcast_publish(handcast_content* content, int64_t time_ns) {
  return with(content, "handcast_publish", [&]() -> Result<void> {
    if (!content->loan)
      return fail(Errc::bad_config,
                  "handcast_publish: no picture was begun; call handcast_begin()");
    auto& picture = **content->loan;
    picture.header.frame_id = ++content->frame;
    picture.header.origin_ns = time_ns > 0 ? time_ns : handcast::now_ns();
    picture.lasts_ns = content->lasts_ns;
    picture.is_straight = content->is_straight ? 1 : 0;
    content->writer.publish(std::move(*content->loan));
    content->loan.reset();
    return {};
  });
}

handcast_result handcast_size(handcast_content* content, int width, int height) {
  return with(content, "handcast_size", [&]() -> Result<void> {
    if (auto fits = check_size("handcast_size", width, height); !fits) return fits;
    if (auto fits = check_room(*content, width, height); !fits) return fits;
    content->loan.reset();
    content->width = width;
    content->height = height;
    return {};
  });
}

handcast_result handcast_set_straight(handcast_content* content, int is_straight) {
  return with(content, "handcast_set_straight", [&]() -> Result<void> {
    content->is_straight = is_straight != 0;
    return {};
  });
}

handcast_result handcast_set_lasts(handcast_content* content, int64_t lasts_ns) {
  return with(content, "handcast_set_lasts", [&]() -> Result<void> {
    if (lasts_ns < 0)
      return fail(Errc::bad_config,
                  fmt::format("handcast_set_lasts: {} ns is less than 0", lasts_ns));
    content->lasts_ns = lasts_ns;
    return {};
  });
}

handcast_result handcast_hands(handcast_content* content, handcast_both_hands* hands) {
  if (hands) *hands = {};
  return with(content, "handcast_hands", [&]() -> Result<void> {
    if (!hands)
      return fail(Errc::bad_config, "handcast_hands: `hands` is NULL; it takes the result");
    auto taken = take_poses(*content, handcast::Deadline::now());
    if (!taken && (taken.error().code != Errc::timeout || !content->newest)) return taken;
    *hands = handcast::client::both_hands(*content->newest);
    return {};
  });
}

handcast_result handcast_wait(handcast_content* content, int timeout_ms) {
  return with(content, "handcast_wait", [&]() -> Result<void> {
    constexpr int kLongest_ms = 10'000;
    if (timeout_ms < 0 || timeout_ms > kLongest_ms)
      return fail(Errc::bad_config,
                  fmt::format("handcast_wait: {} ms is outside 0 to {}", timeout_ms, kLongest_ms));
    return take_poses(*content, handcast::Deadline::in(std::chrono::milliseconds(timeout_ms)));
  });
}

void handcast_close(handcast_content* content) {
  if (!content) return;
  with(content, "handcast_close", [&]() -> Result<void> {
    handcast::client::Handles<handcast_content>::remove(content);
    return {};
  });
}
