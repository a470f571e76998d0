// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>

#include "ipc/base/result.hpp"

namespace handcast::renderer {

/// A film that is open. One thread at a time.
class FilmReader {
 public:
  virtual ~FilmReader() = default;

  /// What the film says about itself.
  /// @{
  virtual int width_px() const = 0;
  virtual int height_px() const = 0;
  virtual std::int64_t frames() const = 0;  ///< number of frames; 0: unknown
  virtual double rate_hz() const = 0;       ///< frames per second; may be any number
  /// @}
  /// Reads frame `index` as grey values, width_px() * height_px() of them. Returns false if it
  /// cannot be read.
  virtual bool read(std::int64_t index, std::uint8_t* grey) = 0;
};

/// Opens a film with OpenCV's videoio, in a library of its own (libhandcast-film.so): videoio loads
/// a hundred other libraries, which would delay every start of a camera service by about 0.1 s.
/// Errors (bad_config): no such file, not a film, this installation has no library for films.
Result<std::unique_ptr<FilmReader>> open_film(const std::filesystem::path& file);

}  // namespace handcast::renderer

/// What the library offers: the film, which the caller deletes; null if it is none.
extern "C" handcast::renderer::FilmReader* handcast_open_film(const char* file);
