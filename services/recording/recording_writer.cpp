// SPDX-License-Identifier: Apache-2.0
#include "services/recording/recording_writer.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <libdeflate.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "ipc/base/write_whole.hpp"
#include "services/recording/about.hpp"

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

namespace fs = std::filesystem;

namespace {

Result<void> make_folder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  const bool empty = !failed && fs::is_empty(folder, failed);
  if (failed)
    return fail(Errc::bad_config,
                fmt::format("{}: cannot be made: {}", folder.string(), failed.message()));
  if (!empty)
    return fail(Errc::bad_config,
                fmt::format("{}: the folder is not empty; name a new one", folder.string()));
  return {};
}

/// The size without the zeros at the end.
std::size_t used(std::span<const std::byte> bytes) {
  while (!bytes.empty() && bytes.back() == std::byte{0}) bytes = bytes.first(bytes.size() - 1);
  return bytes.size();
}

template <class T>
const std::uint8_t* pixels_of(const T& message) {
  if constexpr (requires { message.pixels(); })
    return reinterpret_cast<const std::uint8_t*>(message.pixels());
  else
    return nullptr;
}

}  // namespace

Result<RecordingWriter> RecordingWriter::create(const fs::path& folder, const About& about,
                                                const std::vector<std::string>& streams) {
  for (const auto& name : streams)
    if (!type_of_stream(name))
      return fail(Errc::bad_config,
                  fmt::format("a stream '{}' cannot be recorded: its messages are unknown", name));
  if (auto made = make_folder(folder); !made) return tl::make_unexpected(made.error());
  if (auto kept = write_whole(folder / "rig.toml", about.rig_file); !kept)
    return tl::make_unexpected(kept.error());
  if (!about.calibration.empty())
    if (auto kept = write_whole(folder / kCalibrationFile, about.calibration); !kept)
      return tl::make_unexpected(kept.error());
  for (const auto& [name, contents] : about.files)
    if (auto kept = write_whole(folder / name, contents); !kept)
      return tl::make_unexpected(kept.error());
  if (auto said = write_whole(folder / kAboutFile, about_text(about.rig, streams)); !said)
    return tl::make_unexpected(said.error());
  std::vector<Stream> all;
  for (const auto& name : streams) {
    auto files = StreamFiles::create(folder, name);
    if (!files) return tl::make_unexpected(files.error());
    all.push_back({name, type_of_stream(name), std::move(*files), 0});
  }
  return RecordingWriter(folder, std::move(all));
}

template <class T>
Result<void> RecordingWriter::append(std::size_t stream, const T& message, std::uint64_t sequence,
                                     std::uint64_t lost) {
  auto& to = streams_.at(stream);
  if (to.type != &type_of<T>())
    return fail(Errc::bad_data, fmt::format("{}: not a message of this stream", to.name));
  const auto shape = image_of(message);
  head_.resize(sizeof(T));
  std::memcpy(head_.data(), &message, sizeof(T));
  clear_unused(*reinterpret_cast<T*>(head_.data()));
  to.lost += lost;
  IndexRow row{.width_px = shape.width_px,
               .height_px = shape.height_px,
               .frame_id = message.header.frame_id,
               .origin_ns = message.header.origin_ns,
               .published_ns = message.header.published_ns,
               .sequence = sequence,
               .lost = static_cast<std::uint32_t>(std::min<std::uint64_t>(lost, UINT32_MAX))};
  return store(to, row, {pixels_of(message), shape.bytes()});
}

Result<void> RecordingWriter::store(Stream& stream, IndexRow row,
                                    std::span<const std::uint8_t> pixels) {
  stored_.assign(head_.begin(), head_.begin() + static_cast<std::ptrdiff_t>(used(head_)));
  row.head_bytes = static_cast<std::uint32_t>(stored_.size());
  if (!pixels.empty())
    packer_.append(pixels, {row.width_px, row.height_px, stream.type->channels}, stored_);
  row.image_bytes = static_cast<std::uint32_t>(stored_.size() - row.head_bytes);
  return stream.files.append(row, stored_);
}

template Result<void> RecordingWriter::append(std::size_t, const msg::CameraFrame&, std::uint64_t,
                                              std::uint64_t);
template Result<void> RecordingWriter::append(std::size_t, const msg::HandPoses&, std::uint64_t,
                                              std::uint64_t);
template Result<void> RecordingWriter::append(std::size_t, const msg::Landmarks&, std::uint64_t,
                                              std::uint64_t);
template Result<void> RecordingWriter::append(std::size_t, const msg::Projection&, std::uint64_t,
                                              std::uint64_t);
template Result<void> RecordingWriter::append(std::size_t, const msg::StageMarks&, std::uint64_t,
                                              std::uint64_t);

std::vector<RecordingWriter::Total> RecordingWriter::totals() const {
  std::vector<Total> totals;
  for (const auto& stream : streams_)
    totals.push_back({stream.name, stream.files.messages(), stream.lost, stream.files.bytes()});
  return totals;
}

Result<void> RecordingWriter::finish(const std::string& reason,
                                     const std::vector<std::uint64_t>& lost_at_end) {
  nlohmann::ordered_json streams;
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    streams_[i].lost += lost_at_end.at(i);
    const auto& stream = streams_[i];
    streams[stream.name] = {{"messages", stream.files.messages()},
                            {"lost", stream.lost},
                            {"bytes", stream.files.bytes()}};
  }
  const nlohmann::ordered_json summary{{"ended", reason}, {"streams", streams}};
  return write_whole(
      folder_ / "summary.json",
      summary.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace handcast::recording
