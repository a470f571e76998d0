// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace handcast::test {

/// Aravis's fake GigE Vision camera: packets of the real protocol on the loopback, or on another
/// network interface. It answers at GigE Vision's only port, so that an address can have one at a
/// time.
class FakeCamera {
 public:
  /// Fills an image of `bytes` bytes. Called on the camera's thread.
  using Fill = std::function<void(std::uint8_t* pixels, std::size_t bytes)>;

  /// Makes cameras that are created from now on offer these pixel formats, too: their names and
  /// values in the GenICam convention. `file`: where their description is written.
  static void offer(const std::vector<std::pair<std::string, std::uint32_t>>& formats,
                    const std::string& file);
  /// Undoes offer().
  static void offer_the_usual();

  /// `interface`: an address of this machine, or the name of a network interface.
  explicit FakeCamera(Fill fill = {}, const std::string& interface = "127.0.0.1",
                      const std::string& serial = "GV01");
  FakeCamera(const FakeCamera&) = delete;
  FakeCamera& operator=(const FakeCamera&) = delete;
  ~FakeCamera();

  /// Whether it could take its address.
  bool is_running() const;
  /// The share of packets that are not sent, 0 to 1.
  void lose(double share);
  /// A register (ARV_FAKE_CAMERA_REGISTER_...).
  std::uint32_t read(std::uint32_t address) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace handcast::test
