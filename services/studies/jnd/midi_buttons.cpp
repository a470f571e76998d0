// SPDX-License-Identifier: Apache-2.0
#include "services/studies/jnd/midi_buttons.hpp"

#include <algorithm>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"

namespace handcast::study {

Result<MidiButtons> MidiButtons::open(const std::string& device, const Open& open) {
  auto port = open(device);
  if (!port) return tl::make_unexpected(port.error());
  return MidiButtons(device, open, std::move(*port));
}

/// Of a key (note on), or of a pedal or pad that sends a controller.
bool MidiButtons::is_press(std::span<const std::uint8_t> message) {
  constexpr int kNoteOn = 0x90, kController = 0xb0, kPressed = 64;
  if (message.size() != 3) return false;
  const int kind = message[0] & 0xf0, value = message[2];
  return (kind == kNoteOn && value > 0) || (kind == kController && value >= kPressed);
}

void MidiButtons::look_for_device() {
  constexpr std::int64_t kLookEvery_ns = 1'000'000'000;
  if (now_ns() - looked_ns_ < kLookEvery_ns) return;
  looked_ns_ = now_ns();
  if (port_ && !port_->is_there()) {
    log::warning("{} is gone; the keys of the keyboard answer until it is there again",
                 port_->name());
    port_.reset();
  }
  if (port_) return;
  auto port = open_(device_);
  if (port) port_ = std::move(*port);
}

std::vector<MidiButtons::Button> MidiButtons::pressed() {
  look_for_device();
  std::vector<Button> buttons;
  if (!port_) return buttons;
  for (const auto& message : port_->receive())
    if (is_press(message)) buttons.emplace_back(message[0], message[1]);
  return buttons;
}

bool MidiButtons::learn(const std::string& key) {
  for (const auto& button : pressed())
    if (keys_.try_emplace(button, key).first->second == key) return true;
  return false;
}

std::vector<std::string> MidiButtons::take_keys() {
  std::vector<std::string> keys;
  for (const auto& button : pressed())
    if (const auto found = keys_.find(button); found != keys_.end()) keys.push_back(found->second);
  return keys;
}

}  // namespace handcast::study
