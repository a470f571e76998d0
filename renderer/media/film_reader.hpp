// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::renderer {

/// A film that is open. One thread at a time.
class FilmReader {
 public:
  virtual ~FilmReader() = default;

  /// Size of its frames in pixels, turned as the film asks for.
  /// @{
  virtual int width_px() const = 0;
  virtual int height_px() const = 0;
  /// @}
  /// The times of all frames since the first, ascending; empty if the film does not say them.
  virtual const std::vector<std::int64_t>& times_ns() const = 0;
  /// Reads frame `index` as grey values, width_px() * height_px() of them: its luma, over black if
  /// it is transparent. Returns false if it cannot be read.
  virtual bool read(std::int64_t index, std::uint8_t* grey) = 0;
};

/// Opens a film with FFmpeg, in a library of its own (libhandcast-film.so): it loads many other
/// libraries, which would delay every start of a camera service. Reads the whole file once.
/// Errors (bad_config): no such file, not a film, this installation has no library for films.
Result<std::unique_ptr<FilmReader>> open_film(const std::filesystem::path& file);

}  // namespace handcast::renderer

/// What the library offers: the film, which the caller deletes; null if it is none.
extern "C" handcast::renderer::FilmReader* handcast_open_film(const char* file);
