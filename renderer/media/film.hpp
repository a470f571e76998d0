// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::renderer {

/// A film of JPEG pictures: an AVI file (Microsoft, "AVI RIFF File Reference") in MJPEG. Its header
/// is right after each picture, so it can be read while it is written and after a crash; its index,
/// with which players jump, is written at the end. One thread.
class Film {
 public:
  /// Size of the largest film: some readers take sizes for signed numbers.
  static constexpr std::uint64_t kMostBytes = 2'000'000'000;

  /// Begins a film of pictures of this size in a new file. Errors: bad_config (the file exists or
  /// cannot be created).
  static Result<Film> create(const std::filesystem::path& file, int width_px, int height_px);
  Film(Film&&) = default;
  Film& operator=(Film&&) = delete;
  /// Writes the index.
  ~Film();

  /// Adds a picture that was shown at `time_ns`. The film plays at the mean rate of its pictures.
  /// Errors: unavailable (no space).
  Result<void> add(std::span<const std::uint8_t> jpeg, std::int64_t time_ns);
  /// Whether another picture of this size has room.
  bool has_room_for(std::size_t bytes) const;
  std::uint32_t pictures() const { return static_cast<std::uint32_t>(index_.size()); }

 private:
  struct Entry {
    std::uint32_t offset, bytes;  ///< as in the index: from the word "movi"
  };
  Film(std::filesystem::path file, UniqueFd fd, int width_px, int height_px)
      : file_(std::move(file)), fd_(std::move(fd)), width_px_(width_px), height_px_(height_px) {}
  Result<void> write_at(std::uint64_t offset, std::span<const std::uint8_t> bytes) const;
  std::vector<std::uint8_t> header(std::uint64_t index_bytes) const;

  std::filesystem::path file_;
  UniqueFd fd_;
  int width_px_, height_px_;
  std::vector<Entry> index_;
  std::uint64_t end_ = 0;  ///< of the last picture
  std::uint32_t largest_ = 0;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
};

}  // namespace handcast::renderer
