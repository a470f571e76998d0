// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
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

/// The two files of a stream while they are written. The data of a message is written before its
/// row, both at once, so whatever ends the process leaves whole messages. One thread.
class StreamFiles {
 public:
  /// Creates NAME.data and NAME.index. Errors: unavailable (they cannot be created).
  static Result<StreamFiles> create(const std::filesystem::path& folder, std::string_view stream);

  /// Appends a message; sets `row.offset` and `row.crc`. Errors: unavailable (the disk is full, or
  /// another reason in the sentence): the files hold all messages before this one.
  Result<void> append(IndexRow row, std::span<const std::byte> stored);

  /// What was appended.
  /// @{
  std::uint64_t messages() const { return messages_; }
  std::uint64_t bytes() const { return data_bytes_ + messages_ * sizeof(IndexRow); }
  /// @}

 private:
  StreamFiles(std::filesystem::path base, UniqueFd data, UniqueFd index)
      : base_(std::move(base)), data_(std::move(data)), index_(std::move(index)) {}
  tl::unexpected<Error> cut_back(int error_number);

  std::filesystem::path base_;  ///< of both files, without their endings
  UniqueFd data_, index_;
  std::uint64_t data_bytes_ = 0, messages_ = 0;
};

/// Writes a recording: docs/recordings.md describes its files. One thread.
class RecordingWriter {
 public:
  /// What a recording says about itself.
  struct About {
    std::string rig;          ///< name of the rig
    std::string rig_file;     ///< its settings as TOML; kept in rig.toml
    std::string calibration;  ///< the calibration file, kept in kCalibrationFile; empty: unknown
    std::map<std::string, std::string> files;  ///< others that rig_file names: contents by name
  };

  /// Creates the folder, or takes an empty one, and the files of `streams`, whose names are those
  /// of rings. Errors: bad_config (the folder is not empty; a stream is unknown), unavailable (a
  /// file cannot be written).
  static Result<RecordingWriter> create(const std::filesystem::path& folder, const About& about,
                                        const std::vector<std::string>& streams);

  /// Packs a message with its image and appends it to the stream of this index. `lost`: messages
  /// between this one and the one before that are missing. Errors: bad_data (it is no message of
  /// this stream, or its size is wrong), unavailable (see StreamFiles::append()).
  template <class T>
  Result<void> append(std::size_t stream, const T& message, std::uint64_t sequence,
                      std::uint64_t lost);

  /// Writes summary.json: why the recording ended, and the totals. `lost_at_end`: per stream,
  /// messages behind the last one that are missing. Errors: unavailable.
  Result<void> finish(const std::string& reason, const std::vector<std::uint64_t>& lost_at_end);

  /// One stream so far.
  struct Total {
    std::string stream;
    std::uint64_t messages = 0, lost = 0, bytes = 0;
  };
  std::vector<Total> totals() const;

 private:
  struct Stream {
    std::string name;
    const MessageType* type;
    StreamFiles files;
    std::uint64_t lost = 0;
  };
  RecordingWriter(std::filesystem::path folder, std::vector<Stream> streams)
      : folder_(std::move(folder)), streams_(std::move(streams)) {}
  /// Stores head_ and an image.
  Result<void> store(Stream& stream, IndexRow row, std::span<const std::uint8_t> pixels);

  std::filesystem::path folder_;
  std::vector<Stream> streams_;
  ImagePacker packer_;
  Bytes head_;    ///< the message without its image
  Bytes stored_;  ///< the message as it is stored
};

}  // namespace handcast::recording
