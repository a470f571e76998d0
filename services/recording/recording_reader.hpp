// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"
#include "services/recording/index_row.hpp"
#include "services/recording/packed_image.hpp"
#include "services/recording/streams.hpp"

namespace handcast::recording {

/// Reads the messages of one stream of a recording, in any order, from the disk: only the index is
/// in memory (64 bytes a message). One that was cut off, by a crash or a full disk, is read up to
/// its last whole message. One thread.
class StreamReader {
 public:
  /// Errors: bad_config (the folder is no recording, has no such stream, or messages of another
  /// version of handcast), bad_data (a file is damaged).
  template <class T>
  static Result<StreamReader> open(const std::filesystem::path& folder, std::string_view stream) {
    return open(folder, stream, type_of<T>());
  }

  /// The same for the type that the stream's name implies.
  static Result<StreamReader> open(const std::filesystem::path& folder, std::string_view stream) {
    const auto* type = type_of_stream(stream);
    if (!type) return fail(Errc::bad_config, std::string(stream) + ": no stream of handcast");
    return open(folder, stream, *type);
  }

  /// The index of the whole messages, in the order in which they were published.
  const std::vector<IndexRow>& rows() const { return rows_; }

  /// Reads message `number` and its image, if it has one, to the first bytes of `pixels`. Errors:
  /// bad_data (the message is damaged), bad_config (the image does not fit).
  template <class T>
  Result<void> read(std::size_t number, T& message, std::span<std::uint8_t> pixels = {}) {
    if (auto done = read_stored(number, pixels); !done) return done;
    std::memcpy(&message, head_.data(), sizeof(T));
    if (type_->channels > 0 && image_of(message) != shape_of(rows_[number]))
      return damaged(number, "its image has another size than its index says");
    if (!is_sound(message)) return damaged(number, "it has more hands or marks than there can be");
    return {};
  }
  /// Size of the image of a message.
  ImageShape shape_of(const IndexRow& row) const {
    return {row.width_px, row.height_px, type_->channels};
  }

 private:
  static Result<StreamReader> open(const std::filesystem::path& folder, std::string_view stream,
                                   const MessageType& type);
  StreamReader(std::filesystem::path file, const MessageType& type, UniqueFd data,
               std::vector<IndexRow> rows)
      : file_(std::move(file)), type_(&type), data_(std::move(data)), rows_(std::move(rows)) {}
  Result<void> read_stored(std::size_t number, std::span<std::uint8_t> pixels);
  Result<void> check(const IndexRow& row, std::size_t number, std::size_t room) const;
  tl::unexpected<Error> damaged(std::size_t number, std::string_view what) const;

  std::filesystem::path file_;
  const MessageType* type_;
  UniqueFd data_;
  std::vector<IndexRow> rows_;
  Bytes stored_, head_;
  ImageUnpacker unpacker_;
};

}  // namespace handcast::recording
