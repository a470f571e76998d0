// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::recording {

/// A NumPy array file (.npy, format 1-3, little-endian f4 f8 i4 i8, C order), as doubles.
struct Npy {
  std::vector<std::size_t> shape;  ///< extent of each dimension
  std::vector<double> values;      ///< row-major; as many as the product of the extents
};

/// An array file whose header has been read, so that its shape can be checked before its numbers
/// take memory.
class NpyFile {
 public:
  /// Errors: bad_config (the file cannot be opened), bad_data (malformed content, a size other than
  /// that of the shape, more than 40 million numbers).
  static Result<NpyFile> open(const std::filesystem::path& file);
  /// Extent of each dimension.
  const std::vector<std::size_t>& shape() const { return shape_; }
  /// The number of elements.
  std::size_t count() const { return count_; }
  /// Reads the numbers. Errors: bad_data (the file has changed).
  Result<Npy> read();

 private:
  NpyFile(std::filesystem::path file, UniqueFd fd, std::string type, std::vector<std::size_t> shape,
          std::size_t data_offset, std::size_t count)
      : file_(std::move(file)),
        fd_(std::move(fd)),
        type_(std::move(type)),
        shape_(std::move(shape)),
        data_offset_(data_offset),
        count_(count) {}

  std::filesystem::path file_;
  UniqueFd fd_;
  std::string type_;
  std::vector<std::size_t> shape_;
  std::size_t data_offset_, count_;
};

/// An array of bytes ('|u1', C order) that is read from the disk.
struct NpyBytes {
  UniqueFd fd;
  std::vector<std::size_t> shape;  ///< extent of each dimension
  std::size_t data_offset = 0;     ///< where its first byte is in the file
};
/// Errors: bad_config (the file cannot be opened), bad_data (malformed content, a size other than
/// that of the shape).
Result<NpyBytes> open_npy_bytes(const std::filesystem::path& file);

/// Reads an array of any shape. Errors: as NpyFile::open().
Result<Npy> read_npy(const std::filesystem::path& file);
/// Writes values in row-major order as '<f4'. Errors: unavailable (the file cannot be written),
/// those of check_output().
Result<void> write_npy_f32(const std::filesystem::path& file, const std::vector<std::size_t>& shape,
                           const std::vector<float>& values);
/// Writes a one-dimensional array as '<i8'. Errors: unavailable (the file cannot be written),
/// those of check_output().
Result<void> write_npy_i64(const std::filesystem::path& file,
                           const std::vector<std::int64_t>& values);

}  // namespace handcast::recording
