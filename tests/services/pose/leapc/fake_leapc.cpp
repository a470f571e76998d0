// SPDX-License-Identifier: Apache-2.0
#include "tests/services/pose/leapc/fake_leapc.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <fstream>
#include <limits>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#ifndef FAKE_MAJOR
#define FAKE_MAJOR 5
#endif
#define FAKE_EXPORT extern "C" __attribute__((visibility("default")))

using namespace handcast::test;

namespace {

constexpr std::uint32_t kOk = 0, kInvalid = 0xE2010001, kTimedOut = 0xE2010004,
                        kConcurrent = 0xE201000F, kRefused = 0xE7010006;
constexpr std::uint32_t kDeviceId = 7;

FakeLeap leap;

std::int64_t ours_ns() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}
std::int64_t theirs_us() { return ours_ns() / 1000 + leap.clock_offset_us; }

/// Bytes of a packed structure, field after field.
class Packed {
 public:
  template <class T>
  Packed& add(T value) {
    const auto* begin = reinterpret_cast<const std::uint8_t*>(&value);
    bytes_.insert(bytes_.end(), begin, begin + sizeof value);
    return *this;
  }
  Packed& vector(const std::array<float, 3>& v) { return add(v[0]).add(v[1]).add(v[2]); }
  Packed& rotation(const std::array<float, 4>& q) {
    return add(q[0]).add(q[1]).add(q[2]).add(q[3]);
  }
  std::vector<std::uint8_t>& bytes() { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

std::array<float, 3> turned(const std::array<float, 4>& q, const std::array<float, 3>& v) {
  const float x = q[0], y = q[1], z = q[2], w = q[3];
  const std::array<float, 3> t{2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]),
                               2 * (x * v[1] - y * v[0])};
  return {v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2],
          v[2] + w * t[2] + x * t[1] - y * t[0]};
}

void add_bone(Packed& out, const FakeHand& hand, int bone, int root) {
  out.vector(hand.joints[root]).vector(hand.joints[root + 1]).add(hand.widths[bone]);
  out.rotation(hand.rotations[bone]);
}

void add_palm(Packed& out, const FakeHand& hand) {
  const std::array<float, 3> nothing{};
  const auto& turn = hand.rotations[0];
  out.vector(hand.joints[19]).vector(nothing).vector(nothing).vector(turned(turn, {0, -1, 0}));
  out.add(80.f).vector(turned(turn, {0, 0, -1})).rotation(turn);
}

void add_hand(Packed& out, std::uint32_t id, const FakeHand& hand) {
  out.add(id).add(std::uint32_t{0}).add(std::int32_t{hand.type}).add(hand.confidence);
  out.add(hand.visible_us).add(0.f).add(0.f).add(0.f).add(0.f);
  add_palm(out, hand);
  for (int f = 0; f < 5; ++f) {
    out.add(std::int32_t{f});
    for (int k = 0; k < 4; ++k) add_bone(out, hand, 2 + 4 * f + k, 2 + 8 * f + 2 * k);
    out.add(std::uint32_t{1});
  }
  add_bone(out, hand, 1, 0);
}

/// A flat left hand, or its mirror image, that sways.
FakeHand swaying(std::int64_t k, int which) {
  const float mirror = which % 2 == 0 ? 1 : -1;
  FakeHand hand{.type = which % 2, .visible_us = 1000};
  const float aside =
      -120 * mirror * (which < 2 ? 1.0f : 2.0f) + 30 * std::sin(static_cast<float>(k) * 0.04f);
  hand.rotations.fill({0, 0, 0, 1});
  hand.widths.fill(18);
  hand.joints[0] = {aside, 200, 250};
  hand.joints[1] = {aside, 200, 0};
  for (int f = 0; f < 5; ++f) {
    const float x = aside + mirror * static_cast<float>(30 - 15 * f);
    const std::array<float, 5> z = f == 0 ? std::array<float, 5>{-20, -20, -60, -85, -105}
                                          : std::array<float, 5>{-25, -85, -125, -150, -172};
    for (int k2 = 0; k2 < 4; ++k2)
      for (int end = 0; end < 2; ++end)
        hand.joints[2 + 8 * f + 2 * k2 + end] = {x, 200, z[k2 + end]};
  }
  return hand;
}

struct Event {
  std::int32_t type = 0;
  std::uint32_t device = 0;
  std::vector<std::uint8_t> bytes, hands;
};

struct Connection {
  bool is_open = false, is_up = false, has_device = false;
  std::int64_t frame = 0, next_ns = 0, last_stamp_us = 0;
  Event event;  ///< of the last poll
  std::mutex polling;
};

constexpr std::int32_t kServiceCame = 1, kServiceLost = 2, kDeviceCame = 3, kFrame = 0x100,
                       kDeviceGone = 0x104, kModeChanged = 0x10b;

Event device_event(bool is_there) {
  Packed bytes;
  bytes.add(std::uint32_t{0}).add<void*>(&leap).add(kDeviceId).add(std::uint32_t{is_there});
  return {is_there ? kDeviceCame : kDeviceGone, 0, bytes.bytes(), {}};
}

std::int64_t stamp_of(Connection& connection, std::int64_t due_ns) {
  std::int64_t stamp_us =
      (due_ns - static_cast<std::int64_t>(leap.age_ms * 1e6)) / 1000 + leap.clock_offset_us;
  if (leap.fault == FakeFault::stamps_go_back && connection.last_stamp_us)
    stamp_us = connection.last_stamp_us - 100;
  if (leap.fault == FakeFault::stamps_of_epoch) stamp_us += 1'700'000'000'000'000;
  if (leap.fault == FakeFault::stamps_ahead) stamp_us += 5'000'000;
  return connection.last_stamp_us = stamp_us;
}

Event frame_event(Connection& connection, std::int64_t due_ns) {
  const FakeFault fault = leap.fault;
  if (leap.restarts_numbers.exchange(false)) connection.frame = 0;
  const std::int64_t k = connection.frame++;
  const int count = leap.hands;
  Packed hands;
  for (int which = 0; which < count; ++which) {
    FakeHand hand = swaying(k, which);
    if (auto* motion = leap.motion.load()) motion(k, which, hand);
    if (fault == FakeFault::not_a_number)
      hand.joints[17][1] = std::numeric_limits<float>::quiet_NaN();
    if (fault == FakeFault::no_side) hand.type = 2;
    add_hand(hands, static_cast<std::uint32_t>(which), hand);
  }
  Event event{kFrame, kDeviceId, {}, std::move(hands.bytes())};
  const void* where = event.hands.data();
  if (fault == FakeFault::null_hands) where = nullptr;
  if (fault == FakeFault::bad_hands) where = event.hands.data() - (std::size_t{1} << 46);
  const std::uint32_t told = fault == FakeFault::many_hands ? 0xffffffff : count;
  Packed bytes;
  bytes.add<void*>(nullptr).add(k).add(stamp_of(connection, due_ns)).add(k);
  bytes.add(told).add(where).add(110.f);
  event.bytes = std::move(bytes.bytes());
  return event;
}

/// In another process the device is there while a file is.
bool is_plugged_in() {
  static const char* file = std::getenv(kFakeLeapPlug);
  return !file || ::access(file, F_OK) == 0;
}

bool plug_hangs() {
  static const char* file = std::getenv(kFakeLeapPlug);
  std::string word;
  return file && std::ifstream(file) >> word && word == "hangs";
}

/// Waits for the next event until `until_ns`; false if there is none.
bool next_event(Connection& connection, std::int64_t until_ns) {
  const auto wait = [&](std::int64_t to_ns) {
    std::this_thread::sleep_for(
        std::chrono::nanoseconds(std::clamp<std::int64_t>(to_ns - ours_ns(), 0, 5'000'000)));
  };
  for (;;) {
    const bool has_service = leap.has_service;
    const bool has_device = has_service && leap.has_device && is_plugged_in();
    if (connection.is_open && has_service != connection.is_up) {
      connection.is_up = has_service;
      connection.has_device = false;
      const std::uint32_t flags = 0;
      connection.event = {
          has_service ? kServiceCame : kServiceLost, 0, Packed().add(flags).bytes(), {}};
      return true;
    }
    if (connection.is_up && has_device != connection.has_device) {
      connection.has_device = has_device;
      connection.next_ns = ours_ns();
      connection.event = device_event(has_device);
      return true;
    }
    if (connection.is_up && connection.has_device) {
      const auto period_ns = static_cast<std::int64_t>(1e9 / leap.rate_hz);
      while (connection.next_ns < ours_ns() - 8 * period_ns) {  // the queue was full
        connection.next_ns += period_ns;
        ++connection.frame;
      }
      if (connection.next_ns <= until_ns) {
        while (ours_ns() < connection.next_ns) wait(connection.next_ns);
        connection.event = frame_event(connection, connection.next_ns);
        connection.next_ns += period_ns;
        return true;
      }
    }
    if (ours_ns() >= until_ns) return false;
    wait(until_ns);
  }
}

struct Rebaser {
  std::int64_t offset_us = 0;
};

}  // namespace

FAKE_EXPORT FakeLeap* fake_leap() { return &leap; }

FAKE_EXPORT std::int64_t LeapGetNow() { return theirs_us(); }

FAKE_EXPORT std::uint32_t LeapCreateConnection(const void* config, void** made) {
  std::uint32_t size = 0;
  if (config) std::memcpy(&size, config, sizeof size);
  if (config && size != 16) return kInvalid;  // a library of version 5.4
  *made = new Connection;
  ++leap.connections;
  ++leap.connected;
  return kOk;
}

FAKE_EXPORT std::uint32_t LeapOpenConnection(Connection* connection) {
  connection->is_open = true;
  return kOk;
}

FAKE_EXPORT std::uint32_t LeapPollConnection(Connection* connection, std::uint32_t timeout_ms,
                                             std::uint8_t* message) {
  const std::unique_lock lock(connection->polling, std::try_to_lock);
  if (!lock) {
    ++leap.concurrent_polls;
    return kConcurrent;
  }
  while (leap.fault == FakeFault::hangs || plug_hangs())
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const bool is_there = next_event(*connection, ours_ns() + std::int64_t{timeout_ms} * 1'000'000);
  const Event& event = connection->event;
  std::uint32_t size = 20;
  if (leap.fault == FakeFault::short_message) size = 12;
  if (leap.fault == FakeFault::long_message) size = 40;
  Packed out;
  out.add(size).add(is_there ? event.type : 0);
  const bool is_null = !is_there || leap.fault == FakeFault::null_event;
  out.add<const void*>(is_null ? nullptr : event.bytes.data()).add(event.device);
  if (size > 20) out.bytes().resize(size, 0xee);
  std::copy(out.bytes().begin(), out.bytes().end(), message);
  if (is_there && event.type == kFrame) leap.handed_over_ns = ours_ns();
  return is_there ? kOk : kTimedOut;
}

FAKE_EXPORT void LeapCloseConnection(Connection* connection) { connection->is_open = false; }

FAKE_EXPORT void LeapDestroyConnection(Connection* connection) {
  delete connection;
  --leap.connections;
}

FAKE_EXPORT std::uint32_t LeapSetPolicyFlags(Connection*, std::uint64_t set, std::uint64_t clear) {
  leap.policies = (leap.policies | set) & ~clear;
  return kOk;
}

#ifndef FAKE_WITHOUT_MODE
FAKE_EXPORT std::uint32_t LeapSetTrackingMode(Connection*, std::int32_t mode) {
  if (leap.fault == FakeFault::refused_mode) return kRefused;
  leap.mode = mode;
  return kOk;
}
#endif

FAKE_EXPORT std::uint32_t LeapOpenDevice(void* handle, std::uint32_t id, void** device) {
  if (handle != &leap || id != kDeviceId) return kInvalid;
  *device = &leap;
  ++leap.open_devices;
  return kOk;
}

FAKE_EXPORT void LeapCloseDevice(void*) { --leap.open_devices; }

FAKE_EXPORT std::uint32_t LeapGetDeviceInfo(void*, std::uint8_t* info) {
  std::uint32_t size = 0, room = 0;
  char* serial = nullptr;
  std::memcpy(&size, info, sizeof size);
  std::memcpy(&room, info + 20, sizeof room);
  std::memcpy(&serial, info + 24, sizeof serial);
  if (size != 44) return kInvalid;  // a library before 7.3.1
  const std::uint32_t needed = static_cast<std::uint32_t>(std::strlen(kFakeSerial)) + 1;
  if (serial && room >= needed) std::memcpy(serial, kFakeSerial, needed);
  std::memcpy(info + 20, &needed, sizeof needed);
  return kOk;
}

FAKE_EXPORT std::uint32_t LeapSubscribeEvents(Connection*, void*) {
  ++leap.subscriptions;
  return kOk;
}

FAKE_EXPORT std::uint32_t LeapCreateClockRebaser(Rebaser** made) {
  *made = new Rebaser;
  return kOk;
}

FAKE_EXPORT std::uint32_t LeapUpdateRebase(Rebaser* rebaser, std::int64_t ours_us,
                                           std::int64_t leap_us) {
  rebaser->offset_us = leap_us - ours_us;
  return kOk;
}

FAKE_EXPORT std::uint32_t LeapRebaseClock(Rebaser* rebaser, std::int64_t ours_us,
                                          std::int64_t* leap_us) {
  *leap_us = ours_us + rebaser->offset_us;
  return kOk;
}

FAKE_EXPORT void LeapDestroyClockRebaser(Rebaser* rebaser) { delete rebaser; }

FAKE_EXPORT std::uint32_t LeapGetVersion(void*, std::int32_t part, std::int32_t* version) {
  version[0] = FAKE_MAJOR;
  version[1] = 4;
  version[2] = part;
  return kOk;
}
