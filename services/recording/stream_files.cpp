// SPDX-License-Identifier: Apache-2.0
#include "services/recording/stream_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <libdeflate.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

namespace handcast::recording {
namespace {

/// Returns 0 or an error number.
int write_all(int fd, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const auto written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    if (written == 0) return ENOSPC;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return 0;
}

Result<UniqueFd> create_file(const std::filesystem::path& file) {
  UniqueFd fd(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644));
  if (!fd)
    return fail(Errc::unavailable,
                fmt::format("{}: cannot be created: {}", file.string(), std::strerror(errno)));
  return fd;
}

bool is_full(int error_number) {
  return error_number == ENOSPC || error_number == EDQUOT || error_number == EFBIG;
}

}  // namespace

Result<StreamFiles> StreamFiles::create(const std::filesystem::path& folder,
                                        std::string_view stream) {
  const auto base = folder / stream;
  auto data = create_file(base.string() + ".data");
  if (!data) return tl::make_unexpected(data.error());
  auto index = create_file(base.string() + ".index");
  if (!index) return tl::make_unexpected(index.error());
  return StreamFiles(base, std::move(*data), std::move(*index));
}

Result<void> StreamFiles::append(IndexRow row, std::span<const std::byte> stored) {
  row.offset = data_bytes_;
  row.crc = libdeflate_crc32(0, stored.data(), stored.size());
  if (const int error = write_all(data_.get(), stored); error != 0) return cut_back(error);
  if (const int error = write_all(index_.get(), std::as_bytes(std::span(&row, 1))); error != 0)
    return cut_back(error);
  data_bytes_ += stored.size();
  ++messages_;
  return {};
}

/// Removes the part of a message that was written. Readers ignore it if that fails, too.
tl::unexpected<Error> StreamFiles::cut_back(int error_number) {
  for (const auto& [fd, bytes] :
       {std::pair{index_.get(), messages_ * sizeof(IndexRow)}, std::pair{data_.get(), data_bytes_}})
    if (::ftruncate(fd, static_cast<off_t>(bytes)) == 0) ::lseek(fd, 0, SEEK_END);
  return fail(Errc::unavailable,
              fmt::format("{}.data: {}", base_.string(),
                          is_full(error_number)
                              ? "the disk is full, or the file as large as it may be; free some "
                                "space, or record fewer rings (--rings)"
                              : std::strerror(error_number)));
}

}  // namespace handcast::recording
