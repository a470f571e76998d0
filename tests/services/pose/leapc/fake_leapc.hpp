// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <atomic>
#include <cstdint>

/// A stand-in for Ultraleap's library: the same functions, messages in the order of the real ones,
/// and a service and a device that can fail. It has no code in common with the driver: it writes
/// the structures field by field, as Ultraleap documents them.
namespace handcast::test {

/// A hand that the device sees. Numbered as in Leap's recordings: joints from the elbow, bones from
/// the palm. mm.
struct FakeHand {
  int type = 0;  ///< 0 left, 1 right
  float confidence = 1;
  std::uint64_t visible_us = 1;
  std::array<std::array<float, 3>, 42> joints{};
  std::array<std::array<float, 4>, 22> rotations{};  ///< xyzw; of bone 0: of the palm
  std::array<float, 22> widths{};
};

/// What is wrong with the messages.
enum class FakeFault {
  none,
  null_event,       ///< a message without an event
  null_hands,       ///< hands at no address
  bad_hands,        ///< hands at an address that cannot be read
  many_hands,       ///< more hands than there are
  not_a_number,     ///< in a joint
  no_side,          ///< a hand that is neither left nor right
  stamps_go_back,   ///< each stamp is earlier than the one before it
  stamps_of_epoch,  ///< stamps of another clock, with the right steps
  stamps_ahead,     ///< of the future
  short_message,    ///< of an older layout
  long_message,     ///< of a later layout
  refused_mode,     ///< the tracking mode is refused
  hangs,            ///< a poll that does not return for as long as this is the fault
};

/// The controls of the library in this process. All members may be changed at any time.
struct FakeLeap {
  std::atomic<bool> has_service{true}, has_device{true};
  std::atomic<FakeFault> fault{FakeFault::none};
  std::atomic<int> hands{1};  ///< the first is a left one, the second a right one
  std::atomic<double> rate_hz{110}, age_ms{9};
  std::atomic<std::int64_t> clock_offset_us{12'345'678};  ///< the service's clock, beside ours
  std::atomic<bool> restarts_numbers{false};              ///< the next frame has number 0
  /// The motion: fills the hand `which` of frame `k`. Null: a hand that sways.
  std::atomic<void (*)(std::int64_t k, int which, FakeHand&)> motion{nullptr};

  /// What the driver did.
  /// @{
  std::atomic<int> connections{0};  ///< that exist
  std::atomic<int> connected{0};    ///< how often one was made
  std::atomic<int> open_devices{0};
  std::atomic<int> mode{-1};
  std::atomic<std::uint64_t> policies{0};
  std::atomic<int> subscriptions{0};
  std::atomic<int> concurrent_polls{0};
  std::atomic<std::int64_t> handed_over_ns{0};  ///< when poll returned the last frame
  /// @}
};

/// The name of the function of the library that returns its FakeLeap.
inline constexpr const char* kFakeLeapSymbol = "fake_leap";
/// The variable with the name of a file: the device is there while the file is. While the file says
/// "hangs", no poll returns.
inline constexpr const char* kFakeLeapPlug = "HANDCAST_FAKE_LEAP";
inline constexpr const char* kFakeSerial = "LP12345678901";  ///< of the device

}  // namespace handcast::test
