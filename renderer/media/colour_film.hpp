// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// A film, stream or video device that is open, for its colours. One thread at a time.
class ColourFilm {
 public:
  virtual ~ColourFilm() = default;

  /// Decodes the next frame in the order in which they are shown. Damaged ones are passed over.
  /// Returns its time since the first frame of the film, ns; empty at the end. Errors: timeout (a
  /// stream stalls), disconnected (it has ended, or the device is gone).
  virtual Result<std::optional<std::int64_t>> next() = 0;
  /// Writes that frame, scaled to the size of `out`, as RGBA8 in the levels of sRGB, premultiplied
  /// and turned as the film asks for. Returns false if there is none.
  virtual bool read(Texture& out) = 0;
  /// Goes to the last frame from which it can decode that is at this time or before. Returns false
  /// if that is impossible: a stream.
  virtual bool seek(std::int64_t time_ns) = 0;
  /// From one frame to the next, as far as the film says it; 40 ms otherwise.
  virtual std::int64_t period_ns() const = 0;
  /// True if it has no end and its frames arrive when they are made.
  virtual bool is_live() const = 0;
};

struct FilmOpening {
  enum class Kind { file, stream, device };
  Kind kind = Kind::file;
  std::string address;  ///< a path, "rtsp://…" or "/dev/video0"
  /// What is asked of a device; 0: what it has.
  /// @{
  int width_px = 0, height_px = 0;
  double rate_hz = 0;
  /// @}
  /// How long a stream or device may be silent.
  std::chrono::milliseconds patience{3000};
};

/// Opens it with FFmpeg, as open_film() does. Ends soon, as next() does, when `is_over` becomes
/// true; it outlives the film. Errors: bad_config (no such file; not a film; its codec, which the
/// sentence names, is not in this FFmpeg; not a video device); unavailable (the other side does not
/// answer, no such device, it is used by another program).
Result<std::unique_ptr<ColourFilm>> open_colour_film(const FilmOpening& opening,
                                                     const std::atomic<bool>& is_over);

}  // namespace handcast::renderer

/// What the library offers: the film, which the caller deletes; null and an error otherwise.
extern "C" handcast::renderer::ColourFilm* handcast_open_colour_film(
    const handcast::renderer::FilmOpening& opening, const std::atomic<bool>& is_over,
    handcast::Error& error);
