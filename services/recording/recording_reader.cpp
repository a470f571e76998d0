// SPDX-License-Identifier: Apache-2.0
#include "services/recording/recording_reader.hpp"

#include <fmt/format.h>
#include <libdeflate.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <limits>

#include "ipc/base/input_file.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/quote.hpp"
#include "services/recording/about.hpp"

namespace handcast::recording {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kMostRows = 20'000'000;  ///< ten hours at 525 Hz
constexpr std::uint32_t kLargestSide_px = 16'384;
/// Times outside of this range, or so far apart, cannot be of one clock.
constexpr std::int64_t kLatest_ns = std::numeric_limits<std::int64_t>::max() / 4;
constexpr std::int64_t kLongest_ns = 30 * 86'400'000'000'000;

Result<std::uint64_t> size_of(const UniqueFd& fd, const fs::path& file) {
  struct stat status {};
  if (::fstat(fd.get(), &status) != 0)
    return fail(Errc::bad_data, fmt::format("{}: {}", file.string(), std::strerror(errno)));
  return static_cast<std::uint64_t>(status.st_size);
}

bool read_at(int fd, std::uint64_t offset, std::span<std::byte> bytes) {
  while (!bytes.empty()) {
    const auto got = ::pread(fd, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(got));
    offset += static_cast<std::uint64_t>(got);
  }
  return true;
}

Result<std::vector<IndexRow>> read_rows(const fs::path& file) {
  const auto fd = open_input(file, kMostRows * sizeof(IndexRow));
  if (!fd) return tl::make_unexpected(fd.error());
  const auto bytes = size_of(*fd, file);
  if (!bytes) return tl::make_unexpected(bytes.error());
  std::vector<IndexRow> rows(*bytes / sizeof(IndexRow));
  if (!read_at(fd->get(), 0, std::as_writable_bytes(std::span(rows))))
    return fail(Errc::bad_data, fmt::format("{}: it cannot be read", file.string()));
  return rows;
}

/// What is wrong with the times of a stream; empty if nothing is.
std::string fault_of(const std::vector<IndexRow>& rows) {
  for (const auto& row : rows) {
    const bool in_range = row.published_ns >= 0 && row.published_ns <= kLatest_ns &&
                          row.origin_ns >= -kLatest_ns && row.origin_ns <= kLatest_ns;
    if (!in_range || std::abs(row.published_ns - row.origin_ns) > kLongest_ns)
      return "a message was published at an impossible time";
  }
  if (!rows.empty() && std::abs(rows.back().published_ns - rows.front().published_ns) > kLongest_ns)
    return "the recording is longer than 30 days";
  return {};
}

/// Removes the rows whose messages are not in the data: the last ones if the recording was cut off,
/// others if they are damaged. Returns how many.
std::size_t keep_whole(std::vector<IndexRow>& rows, std::uint64_t data_bytes) {
  return std::erase_if(rows, [&](const IndexRow& row) {
    return row.offset > data_bytes ||
           std::uint64_t{row.head_bytes} + row.image_bytes > data_bytes - row.offset;
  });
}

Result<void> check_layout(const fs::path& folder, std::string_view stream,
                          const MessageType& type) {
  const auto about = read_about(folder);
  if (!about) return tl::make_unexpected(about.error());
  const auto found = about->layouts.find(std::string(stream));
  if (found == about->layouts.end())
    return fail(Errc::bad_config,
                fmt::format("{}: the recording has no stream '{}'", folder.string(), stream));
  if (found->second != type.layout)
    return fail(Errc::bad_config,
                fmt::format("{}: the messages of '{}' are of type {}, and this version of "
                            "handcast reads '{}'; play it with the version that recorded it",
                            folder.string(), stream, quote(found->second), type.layout));
  return {};
}

}  // namespace

Result<StreamReader> StreamReader::open(const fs::path& folder, std::string_view stream,
                                        const MessageType& type) {
  if (auto fits = check_layout(folder, stream, type); !fits)
    return tl::make_unexpected(fits.error());
  const auto base = (folder / stream).string();
  auto rows = read_rows(base + ".index");
  if (!rows) return tl::make_unexpected(rows.error());
  auto data = open_input(base + ".data", std::numeric_limits<std::int64_t>::max());
  if (!data) return tl::make_unexpected(data.error());
  const auto data_bytes = size_of(*data, base + ".data");
  if (!data_bytes) return tl::make_unexpected(data_bytes.error());
  if (const auto lost = keep_whole(*rows, *data_bytes); lost > 0)
    log::warning("{}: {} of {} messages are not whole and are left out", base, lost,
                 lost + rows->size());
  if (const auto fault = fault_of(*rows); !fault.empty())
    return fail(Errc::bad_data, fmt::format("{}.index: {}", base, fault));
  return StreamReader(base + ".data", type, std::move(*data), std::move(*rows));
}

tl::unexpected<Error> StreamReader::damaged(std::size_t number, std::string_view what) const {
  return fail(Errc::bad_data, fmt::format("{}: message {}: {}", file_.string(), number, what));
}

Result<void> StreamReader::check(const IndexRow& row, std::size_t number, std::size_t room) const {
  if (row.head_bytes > type_->bytes) return damaged(number, "it is larger than its type");
  if (std::max(row.width_px, row.height_px) > kLargestSide_px)
    return damaged(number, "its image is larger than any");
  const auto shape = shape_of(row);
  if ((shape.bytes() == 0) != (row.image_bytes == 0))
    return damaged(number, "its image has no size, or its size no image");
  // The runs of DEFLATE make at most 258 bytes of two bits.
  if (shape.bytes() > 1100 * std::uint64_t{row.image_bytes})
    return damaged(number, "its image is larger than its data can be");
  if (shape.bytes() > room)
    return fail(Errc::bad_config,
                fmt::format("{}: message {}: its image of {} x {} px does not fit the place for it",
                            file_.string(), number, row.width_px, row.height_px));
  return {};
}

/// Fills head_ with the message.
Result<void> StreamReader::read_stored(std::size_t number, std::span<std::uint8_t> pixels) {
  const auto& row = rows_.at(number);
  if (auto fine = check(row, number, pixels.size()); !fine) return fine;
  stored_.resize(std::size_t{row.head_bytes} + row.image_bytes);
  if (!read_at(data_.get(), row.offset, stored_)) return damaged(number, "it cannot be read");
  if (libdeflate_crc32(0, stored_.data(), stored_.size()) != row.crc)
    return damaged(number, "its checksum is wrong");
  head_.assign(stored_.begin(), stored_.begin() + row.head_bytes);
  head_.resize(type_->bytes);
  const auto shape = shape_of(row);
  if (shape.bytes() > 0 && !unpacker_.read(std::span(stored_).subspan(row.head_bytes), shape,
                                           pixels.first(shape.bytes())))
    return damaged(number, "its image is damaged");
  return {};
}

}  // namespace handcast::recording
