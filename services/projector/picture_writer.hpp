// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>

#include "ipc/base/result.hpp"
#include "renderer/media/film.hpp"
#include "renderer/output/light.hpp"
#include "renderer/pipeline/frame.hpp"

namespace handcast::projector {

/// Writes the light of frames to files on a thread of its own, as PNG pictures or as a film. If
/// frames come faster than that, only the newest one waits; so the last one is never left out. One
/// thread calls it.
class PictureWriter {
 public:
  /// Writes to light_000.png … light_099.png in the folder, then from the first again, or to
  /// light.avi: light-2.avi if there is one, and so on.
  PictureWriter(std::filesystem::path folder, bool is_film);
  /// Waits until the last frame is written.
  ~PictureWriter();
  PictureWriter(const PictureWriter&) = delete;
  PictureWriter& operator=(const PictureWriter&) = delete;

  /// Has the whole projector image written, dark outside the region of the frame, and returns at
  /// once. Errors: unavailable, bad_config (a frame before could not be written).
  Result<void> write(const renderer::Frame& frame, const renderer::LightTable& light,
                     std::int64_t time_ns);

 private:
  /// A projector image, and when it is lit.
  struct Picture {
    renderer::Texture light;
    renderer::Rect lit;  ///< the part of it that may not be dark
    std::int64_t time_ns = 0;
  };

  void work();
  Result<void> write_picture();
  Result<void> write_to_film();
  Result<void> begin_film();

  std::filesystem::path folder_;
  bool is_film_;
  std::uint64_t written_ = 0, left_out_ = 0;

  std::mutex mutex_;  ///< for what follows
  std::condition_variable changed_;
  bool is_waiting_ = false, is_ending_ = false;
  Picture waiting_;      ///< if is_waiting_, what is to be written next
  Result<void> failed_;  ///< why a frame since the last call could not be written
  // The thread's own.
  Picture written_now_;
  std::uint64_t number_ = 0;  ///< of the next picture
  std::optional<renderer::Film> film_;

  std::thread thread_;
};

}  // namespace handcast::projector
