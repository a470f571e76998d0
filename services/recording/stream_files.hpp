// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"
#include "services/recording/index_row.hpp"

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

}  // namespace handcast::recording
