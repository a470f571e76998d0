// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "services/desk/midi/port/port.hpp"

namespace handcast::study {

/// Buttons of a MIDI device (keys, pads, pedals) that are pressed instead of keys of the keyboard.
/// A device that is pulled is looked for, each second at most. One thread.
class MidiButtons {
 public:
  using Open = std::function<Result<std::unique_ptr<desk::midi::Port>>(std::string_view device)>;

  /// Errors: those of desk::midi::open_port().
  static Result<MidiButtons> open(const std::string& device,
                                  const Open& open = desk::midi::open_port);

  /// Lets the button that was pressed first since the last call stand for a key. Returns false if
  /// none was pressed that stands for no other key.
  bool learn(const std::string& key);
  /// The keys of the buttons that were pressed since the last call.
  std::vector<std::string> take_keys();

 private:
  using Button = std::pair<int, int>;  ///< kind of the message with its channel, number
  MidiButtons(std::string device, Open open, std::unique_ptr<desk::midi::Port> port)
      : device_(std::move(device)), open_(std::move(open)), port_(std::move(port)) {}
  static bool is_press(std::span<const std::uint8_t> message);
  std::vector<Button> pressed();
  void look_for_device();

  std::string device_;
  Open open_;
  std::unique_ptr<desk::midi::Port> port_;  ///< null: it was pulled
  std::int64_t looked_ns_ = 0;
  std::map<Button, std::string> keys_;
};

}  // namespace handcast::study
