// SPDX-License-Identifier: Apache-2.0
// What Ultraleap's library delivers: messages of any size and kind, events that are too short,
// hands that are not there, numbers that are none, and clocks that lie. The input is a sequence of
// polls. Limits: 10 s and 1 GB per input.
#include <cmath>
#include <condition_variable>
#include <mutex>

#include "ipc/base/log.hpp"
#include "services/pose/leapc/connection.hpp"
#include "tests/fuzz/input.hpp"

namespace {

using namespace handcast;
using namespace handcast::pose::leapc;

/// Memory that ends where nothing can be read.
class Guarded {
 public:
  Guarded()
      : page_(static_cast<std::size_t>(sysconf(_SC_PAGESIZE))),
        room_(static_cast<std::uint8_t*>(mmap(nullptr, kPages * page_, PROT_READ | PROT_WRITE,
                                              MAP_PRIVATE | MAP_ANONYMOUS, -1, 0))) {
    if (room_ == MAP_FAILED || mprotect(end(), page_, PROT_NONE) != 0) std::abort();
  }

  /// The bytes at the end of the memory.
  const void* hold(std::span<const std::uint8_t> bytes) {
    std::uint8_t* const begin = end() - bytes.size();
    std::ranges::copy(bytes, begin);
    return begin;
  }

 private:
  static constexpr std::size_t kPages = 7;  // one of them is not readable

  std::uint8_t* end() { return room_ + (kPages - 1) * page_; }

  std::size_t page_;
  std::uint8_t* room_;
};

/// The library: what its functions say comes from the input.
struct Service {
  fuzz::Reader input{{}};
  Mailbox* mailbox = nullptr;
  Guarded event, hands;
  std::int64_t last_ns = 0;
  std::uint64_t last_id = 0;
  std::mutex mutex;
  std::condition_variable ended;
  bool has_ended = false;
};

Service& service() {
  static Service service;
  return service;
}

/// The samples that the driver has made increase, and their numbers are finite.
void check_sample() {
  const auto sample = service().mailbox->take(Deadline::now());
  if (!sample) return fuzz::require(!sample.error().what.empty());
  fuzz::require(sample->header.origin_ns > service().last_ns && sample->count <= msg::kMaxHands);
  fuzz::require(service().last_ns == 0 || sample->header.frame_id > service().last_id);
  service().last_ns = sample->header.origin_ns;
  service().last_id = sample->header.frame_id;
  for (std::uint32_t i = 0; i < sample->count; ++i)
    for (const auto& joint : sample->hands[i].joints) {
      for (const float part : joint.position_m) fuzz::require(std::isfinite(part));
      for (const float part : joint.orientation_xyzw) fuzz::require(std::isfinite(part));
      fuzz::require(std::isfinite(joint.radius_m));
    }
}

/// The event of a message; that of a frame refers to its hands.
const void* event_of(std::int32_t type) {
  auto& input = service().input;
  const auto bytes = input.take(input.number<std::uint8_t>());
  const void* event = service().event.hold(bytes);
  if (type != kTracking) return bytes.empty() ? nullptr : event;
  const void* hands = service().hands.hold(input.take(input.number<std::uint16_t>()));
  if (bytes.size() >= offsetof(TrackingEvent, hands) + sizeof hands)
    std::memcpy(const_cast<std::uint8_t*>(static_cast<const std::uint8_t*>(event)) +
                    offsetof(TrackingEvent, hands),
                &hands, sizeof hands);
  return event;
}

Status end_of_input() {
  std::unique_lock lock(service().mutex);
  service().has_ended = true;
  service().ended.notify_all();
  return kTimeout;
}

Status poll_connection(ConnectionHandle, std::uint32_t, Message* message) {
  constexpr std::array kTypes{kConnection, kConnectionLost, kDevice,       kTracking,
                              kTracking,   kDeviceLost,     kTrackingMode, std::int32_t{0x7fff}};
  check_sample();
  auto& input = service().input;
  if (input.at_end()) return end_of_input();
  message->type = kTypes[input.number<std::uint8_t>() % kTypes.size()];
  message->size = input.number<std::uint8_t>();
  message->device_id = input.number<std::uint8_t>();
  message->event = event_of(message->type);
  return kSuccess;
}

Status device_info(DeviceHandle, DeviceInfo* info) {
  const auto bytes = service().input.take(info->serial_length);
  std::ranges::copy(bytes, info->serial);
  return service().input.number<std::uint8_t>() % 2 == 0 ? kSuccess : kUnsupported;
}

template <class Handle>
Handle some_handle() {
  static int thing;
  return reinterpret_cast<Handle>(&thing);
}

Functions functions() {
  return {
      .now_us = [] { return service().input.number<std::int64_t>(); },
      .create_connection =
          [](const ConnectionConfig*, ConnectionHandle* made) {
            *made = some_handle<ConnectionHandle>();
            return kSuccess;
          },
      .open_connection = [](ConnectionHandle) { return kSuccess; },
      .poll = poll_connection,
      .close_connection = [](ConnectionHandle) {},
      .destroy_connection = [](ConnectionHandle) {},
      .set_policies = [](ConnectionHandle, std::uint64_t, std::uint64_t) { return kSuccess; },
      .set_mode = [](ConnectionHandle, std::int32_t) { return kSuccess; },
      .open_device =
          [](DeviceRef, DeviceHandle* made) {
            *made = some_handle<DeviceHandle>();
            return service().input.number<std::uint8_t>() % 4 == 0 ? kNotAvailable : kSuccess;
          },
      .close_device = [](DeviceHandle) {},
      .device_info = device_info,
      .create_rebaser =
          [](RebaserHandle* made) {
            *made = some_handle<RebaserHandle>();
            return kSuccess;
          },
      .update_rebaser = [](RebaserHandle, std::int64_t, std::int64_t) { return kSuccess; },
      .rebase =
          [](RebaserHandle, std::int64_t, std::int64_t* theirs_us) {
            *theirs_us = service().input.number<std::int64_t>();
            return kSuccess;
          },
      .destroy_rebaser = [](RebaserHandle) {},
      .version = nullptr,
      .subscribe = nullptr,
  };
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  log::set_level(log::Level::error);
  fuzz::Reader input({data, size});
  config::Leapc settings;
  if (input.number<std::uint8_t>() % 2 == 1) settings.device = "LP1";
  Mailbox mailbox;
  service().input = input;
  service().mailbox = &mailbox;
  service().last_ns = 0;
  service().has_ended = false;
  const Connection connection({.path = "libLeapC.so", .version = "", .call = functions()}, settings,
                              0, mailbox);
  std::unique_lock lock(service().mutex);
  service().ended.wait(lock, [] { return service().has_ended; });
  return 0;
}
