// SPDX-License-Identifier: Apache-2.0
// What a program outside the rig sends to a back end `external`: its ring as bytes, then messages.
// What is passed on must be hands of now with numbers in their ranges. Limits: 10 s and 1 GB per
// input.
#include <unistd.h>

#include <cmath>

#include "ipc/msg/guest_streams.hpp"
#include "ipc/ring/writer.hpp"
#include "services/runtime/guest_stream.hpp"
#include "tests/fuzz/input.hpp"

namespace {

using namespace handcast;

template <class T>
ipc::Segment ring(std::string_view stream) {
  return *ipc::Segment::create(ipc::RingSpec::of<T>(std::string(stream), 4, true));
}

void require_usable(const msg::HandPoses& poses) {
  fuzz::require(poses.count <= poses.hands.size());
  for (const auto& hand : std::span(poses.hands).first(poses.count))
    for (const auto& joint : hand.joints)
      for (const float place : joint.position_m) fuzz::require(std::isfinite(place));
}

void require_usable(const msg::Landmarks& landmarks) {
  fuzz::require(landmarks.count <= landmarks.hands.size());
  for (const auto& hand : std::span(landmarks.hands).first(landmarks.count))
    for (const auto& point : hand.points)
      fuzz::require(std::isfinite(point.x_px) && point.sigma_px >= 0);
}

template <class T>
void send(fuzz::Reader& input, std::string_view stream) {
  const auto segment = ring<T>(stream);
  const auto again = [&](std::string_view = {}) {
    return ipc::Segment::open(UniqueFd(::dup(segment.fd())));
  };
  auto guests = *service::GuestStream<T>::open(again, stream, ipc::Wait::futex);
  const bool is_noise = input.number<std::uint8_t>() % 2 == 1;
  if (is_noise) {
    const auto noise = input.take(segment.size() - 4096);
    std::memcpy(segment.data() + 4096, noise.data(), noise.size());
  } else {
    auto message = input.number<T>();
    if (__builtin_add_overflow(message.header.origin_ns, now_ns(), &message.header.origin_ns))
      return;
    ipc::Writer<T>::attach(*again())->publish(message);
  }
  const auto taken = guests.latest(Deadline::now());
  if (taken)
    require_usable(**taken);
  else
    fuzz::require(!taken.error().what.empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Reader input({data, size});
  if (input.number<std::uint8_t>() % 2 == 0)
    send<msg::HandPoses>(input, msg::kGuestPoses);
  else
    send<msg::Landmarks>(input, msg::kGuestLandmarks);
  return 0;
}
