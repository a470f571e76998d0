// SPDX-License-Identifier: Apache-2.0
#include "tests/services/camera/leap/leap_model.hpp"

#include <algorithm>

#include "ipc/base/clock.hpp"
#include "services/camera/leap/little_endian.hpp"

namespace handcast::test {
namespace {

using camera::leap::get_16;
using camera::leap::put_32;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kPayload = 16380, kHeader = 12, kData = kPayload - kHeader;
/// What the controller can hold.
constexpr std::int64_t kHeld_ns = 2'000'000;
/// The stamps begin shortly before their numbers wrap.
constexpr std::uint32_t kFirstStamp = 0xfffff000;
constexpr int kClock_hz = 1000;

void add_16(Bytes& bytes, unsigned number) {
  bytes.push_back(static_cast<std::uint8_t>(number));
  bytes.push_back(static_cast<std::uint8_t>(number >> 8));
}
void add_32(Bytes& bytes, std::uint32_t number) {
  add_16(bytes, number & 0xffff);
  add_16(bytes, number >> 16);
}
void add(Bytes& bytes, std::initializer_list<std::uint8_t> more) {
  bytes.insert(bytes.end(), more);
}

void add_frame(Bytes& bytes, std::uint8_t number, const LeapMode& mode) {
  const auto pixels = static_cast<std::uint32_t>(mode.width_px * mode.height_px);
  add(bytes, {30, 0x24, 5, number, 0});
  add_16(bytes, static_cast<unsigned>(mode.width_px));
  add_16(bytes, static_cast<unsigned>(mode.height_px));
  for (int i = 0; i < 2; ++i) add_32(bytes, 282'624'000);
  add_32(bytes, pixels * 2);
  add_32(bytes, mode.ticks);
  bytes.push_back(1);
  add_32(bytes, mode.ticks);
}

}  // namespace

Bytes LeapModel::configuration() const {
  Bytes bytes{9, 2, 0, 0, 2, 1, 0, 0x80, 250};
  add(bytes, {8, 11, 0, 2, 14, 3, 0, 0});    // both interfaces belong together
  add(bytes, {9, 4, 0, 0, 1, 14, 1, 0, 0});  // video control
  add(bytes, {13, 0x24, 1, 0, 1, 80, 0});
  add_32(bytes, kClock_hz);
  add(bytes, {1, 1});
  add(bytes, {7, 5, 0x82, 3, 0x40, 0, 8});
  add(bytes, {9, 4, 1, 0, 1, 14, 2, 0, 0});  // video streaming
  add(bytes, {14, 0x24, 1, 1, 0xdd, 0, 0x83, 0, 3, 0, 0, 0, 1, 0});
  add(bytes, {27,   0x24, 4,   1,    static_cast<std::uint8_t>(modes.size()),
              'Y',  'U',  'Y', '2',  0,
              0,    0x10, 0,   0x80, 0,
              0,    0xaa, 0,   0x38, 0x9b,
              0x71, 16,   4,   0,    0,
              0,    0});
  for (std::size_t i = 0; i < modes.size(); ++i)
    add_frame(bytes, static_cast<std::uint8_t>(i + 1), modes[i]);
  add(bytes, {7, 5, 0x83, 2, 0, 2, 1});
  bytes[2] = static_cast<std::uint8_t>(bytes.size());
  bytes[3] = static_cast<std::uint8_t>(bytes.size() >> 8);
  return bytes;
}

std::optional<Bytes> LeapModel::control(std::span<const std::uint8_t, 8> setup,
                                        std::span<const std::uint8_t> data) {
  const bool reads = setup[0] == 0xa1 && setup[1] == 0x81;
  const bool writes = setup[0] == 0x21 && setup[1] == 0x01;
  const int selector = setup[3], unit = setup[5], interface = setup[4];
  if (!reads && !writes) return std::nullopt;
  if (interface == 0 && writes) {
    if (data.size() != 2 || refused == std::pair(unit, selector)) return std::nullopt;
    controls[{unit, selector}] = get_16(data, 0);
    if (unit == 5 && selector == 10) is_locked = false;
    return Bytes{};
  }
  if (interface == 0) {
    const auto address = static_cast<std::size_t>(controls[{5, 8}]);
    Bytes memory(serial.begin(), serial.end());
    memory.resize(100);
    memory.insert(memory.end(), calibration.begin(), calibration.end());
    return selector == 7 ? Bytes{address < memory.size() ? memory[address] : std::uint8_t{0}, 0}
                         : Bytes{0, 0};
  }
  if (interface != 1 || (selector != 1 && selector != 2)) return std::nullopt;
  if (reads) return probed_;
  if (data.size() != 26 || data[2] != 1 || data[3] == 0 || data[3] > modes.size())
    return std::nullopt;
  probed_.assign(data.begin(), data.end());
  put_32(probed_, 22, kPayload);
  if (selector == 2) start(data[3] - 1);
  return Bytes{};
}

std::int64_t LeapModel::period_ns() const {
  return static_cast<std::int64_t>(100 * mode_.ticks / (1 + drift));
}

std::size_t LeapModel::payloads() const { return (image_.size() + kData - 1) / kData; }

std::int64_t LeapModel::due_ns() const {
  return begun_ns(number_) + period_ns() * static_cast<std::int64_t>(payload_ + 1) /
                                 static_cast<std::int64_t>(payloads() + 1);
}

void LeapModel::start(int mode) {
  mode_ = modes[static_cast<std::size_t>(mode)];
  is_streaming_ = !is_locked;
  number_ = first_ = starts_++ * numbers_per_start;
  payload_ = 0;
  is_losing_ = false;
  start_ns_ = now_ns() + period_ns();
  image_.resize(2 * static_cast<std::size_t>(mode_.width_px) *
                static_cast<std::size_t>(mode_.height_px));
  draw();
}

void LeapModel::draw() {
  if (draw_picture) return draw_picture(number_, image_);
  for (std::size_t i = 0; i < image_.size(); i += 2) {
    image_[i] = left_of(number_);
    image_[i + 1] = right_of(number_);
  }
  for (std::size_t i = 0; i < 4; ++i)
    image_[2 * i] = image_[2 * i + 1] = static_cast<std::uint8_t>(number_ >> 8 * i);
}

Bytes LeapModel::payload() const {
  const std::size_t from = payload_ * kData, to = std::min(from + kData, image_.size());
  Bytes bytes(kHeader);
  bytes[0] = kHeader;
  bytes[1] = static_cast<std::uint8_t>(0x80 | (has_stamps ? 0x0c : 0) | frame_id_ |
                                       (to == image_.size() ? 2 : 0));
  const auto since_ns = static_cast<double>(begun_ns(number_) - start_ns_) * (1 + drift);
  put_32(bytes, 2, kFirstStamp + static_cast<std::uint32_t>(since_ns * 1e-9 * kClock_hz));
  bytes.insert(bytes.end(), image_.begin() + static_cast<std::ptrdiff_t>(from),
               image_.begin() + static_cast<std::ptrdiff_t>(to));
  return bytes;
}

void LeapModel::advance() {
  if (++payload_ < payloads()) return;
  payload_ = 0;
  ++number_;
  frame_id_ = !frame_id_;
  is_losing_ = false;
  draw();
}

void LeapModel::overflow(std::int64_t now_ns) {
  while (is_streaming_ && due_ns() < now_ns - kHeld_ns) advance();
}

std::optional<LeapModel::Delivery> LeapModel::next(std::int64_t now_ns) {
  while (is_streaming_ && due_ns() <= now_ns) {
    Delivery delivery;
    if (!faults_.empty() && !is_losing_) {
      delivery.fault = faults_.front();
      // An image is lost from its first payload on.
      if (delivery.fault == LeapFault::lost_frame && payload_ != 0)
        delivery.fault = LeapFault::none;
      else
        faults_.pop_front();
    }
    is_losing_ = is_losing_ || delivery.fault == LeapFault::lost_frame ||
                 delivery.fault == LeapFault::lost_end;
    if (delivery.fault == LeapFault::hang) return stop(), std::nullopt;
    const bool is_lost = is_losing_ || delivery.fault == LeapFault::lost_payload;
    if (!is_lost) delivery.bytes = payload();
    advance();
    if (is_lost) continue;
    auto& bytes = delivery.bytes;
    if (delivery.fault == LeapFault::short_payload) bytes.resize(bytes.size() / 2);
    if (delivery.fault == LeapFault::garbage_header) bytes[0] = 0xff, bytes[1] = 0x55;
    if (delivery.fault == LeapFault::error_bit) bytes[1] |= 0x40;
    return delivery;
  }
  return std::nullopt;
}

}  // namespace handcast::test
