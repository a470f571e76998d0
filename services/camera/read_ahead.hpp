// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "ipc/base/clock.hpp"
#include "services/camera/played_pictures.hpp"

namespace handcast::camera {

/// Reads images before they are due, on a thread of its own: the disk may take its time, and a long
/// recording takes little memory. Used by one thread.
class ReadAhead {
 public:
  /// One image that was read.
  struct Picture {
    msg::CameraFrame frame;            ///< as PictureSource::read() fills it
    std::vector<std::uint8_t> pixels;  ///< rows without padding
  };

  /// Begins to read at `first`. Numbers count over all laps of `count` images of `bytes` bytes.
  ReadAhead(std::unique_ptr<PictureSource> source, std::size_t count, std::size_t bytes,
            std::uint64_t first);
  ~ReadAhead();

  /// The image of a number, not lower than that of the call before; waits for it until the
  /// deadline. It is valid until the next call. Errors: timeout, bad_data (it is damaged).
  Result<const Picture*> get(std::uint64_t number, Deadline deadline);

 private:
  struct Slot {
    std::uint64_t number = 0;
    bool done = false;  ///< it has been read
    Result<void> result;
    Picture picture;
  };
  void run();

  static constexpr std::size_t kSlots = 16;
  std::unique_ptr<PictureSource> source_;
  std::size_t count_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::array<Slot, kSlots> slots_;  ///< number k is in slot k % kSlots
  std::uint64_t wanted_;            ///< slots of this number and the next ones are kept
  std::uint64_t next_;              ///< what is read next
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace handcast::camera
