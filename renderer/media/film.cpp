// SPDX-License-Identifier: Apache-2.0
#include "renderer/media/film.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>

namespace handcast::renderer {
namespace {

constexpr std::uint64_t kHeader = 224;         ///< bytes before the first picture
constexpr std::uint64_t kMovie = kHeader - 4;  ///< where the word "movi" is
constexpr std::uint32_t kHasIndex = 0x10, kKeyFrame = 0x10;

/// Little-endian words one after the other.
class Words {
 public:
  Words& text(std::string_view four) {
    bytes_.insert(bytes_.end(), four.begin(), four.end());
    return *this;
  }
  Words& u32(std::uint64_t value) { return number(value, 4); }
  Words& u16(std::uint64_t value) { return number(value, 2); }
  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  Words& number(std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) bytes_.push_back(static_cast<std::uint8_t>(value >> 8 * i));
    return *this;
  }
  std::vector<std::uint8_t> bytes_;
};

std::uint64_t even(std::uint64_t bytes) { return bytes + bytes % 2; }

}  // namespace

Result<Film> Film::create(const std::filesystem::path& file, int width_px, int height_px) {
  UniqueFd fd(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644));
  if (!fd)
    return fail(Errc::bad_config,
                fmt::format("'{}' cannot be created: {}", file.string(), std::strerror(errno)));
  Film film(file, std::move(fd), width_px, height_px);
  film.end_ = kHeader;
  if (auto written = film.write_at(0, film.header(0)); !written)
    return tl::make_unexpected(written.error());
  return film;
}

/// The first kHeader bytes of the file. `index_bytes`: those after the pictures.
std::vector<std::uint8_t> Film::header(std::uint64_t index_bytes) const {
  const auto count = index_.size();
  const auto picture_us =
      count < 2 ? std::int64_t{40'000}
                : std::max<std::int64_t>(
                      (last_ns_ - first_ns_) / 1000 / static_cast<std::int64_t>(count - 1), 1);
  const auto width = static_cast<std::uint32_t>(width_px_),
             height = static_cast<std::uint32_t>(height_px_);
  const auto us = static_cast<std::uint64_t>(picture_us);
  Words words;
  words.text("RIFF").u32(end_ + index_bytes - 8).text("AVI ");
  words.text("LIST").u32(192).text("hdrl");
  words.text("avih").u32(56);  // MainAVIHeader
  words.u32(us).u32(0).u32(0).u32(index_bytes > 0 ? kHasIndex : 0).u32(count).u32(0).u32(1);
  words.u32(largest_).u32(width).u32(height).u32(0).u32(0).u32(0).u32(0);
  words.text("LIST").u32(116).text("strl");
  words.text("strh").u32(56);  // AVIStreamHeader
  words.text("vids").text("MJPG").u32(0).u16(0).u16(0).u32(0).u32(us).u32(1'000'000).u32(0);
  words.u32(count).u32(largest_).u32(0xffffffff).u32(0).u16(0).u16(0).u16(width).u16(height);
  words.text("strf").u32(40);  // BITMAPINFOHEADER
  words.u32(40).u32(width).u32(height).u16(1).u16(24).text("MJPG").u32(3 * width * height);
  words.u32(0).u32(0).u32(0).u32(0);
  words.text("LIST").u32(end_ - kMovie).text("movi");
  return words.take();
}

Result<void> Film::write_at(std::uint64_t offset, std::span<const std::uint8_t> bytes) const {
  while (!bytes.empty()) {
    const auto written =
        ::pwrite(fd_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0)
      return fail(Errc::unavailable,
                  fmt::format("'{}' cannot be written: {}", file_.string(), std::strerror(errno)));
    offset += static_cast<std::uint64_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return {};
}

bool Film::has_room_for(std::size_t bytes) const {
  return end_ + bytes + 16 * (index_.size() + 2) < kMostBytes;
}

Result<void> Film::add(std::span<const std::uint8_t> jpeg, std::int64_t time_ns) {
  auto chunk = Words().text("00dc").u32(jpeg.size()).take();
  chunk.insert(chunk.end(), jpeg.begin(), jpeg.end());
  chunk.resize(even(chunk.size()));
  if (auto written = write_at(end_, chunk); !written) return written;
  const auto bytes = static_cast<std::uint32_t>(jpeg.size());
  index_.push_back({static_cast<std::uint32_t>(end_ - kMovie), bytes});
  end_ += chunk.size();
  largest_ = std::max(largest_, bytes);
  if (index_.size() == 1) first_ns_ = time_ns;
  last_ns_ = time_ns;
  return write_at(0, header(0));
}

Film::~Film() {
  if (!fd_ || index_.empty()) return;
  Words words;
  words.text("idx1").u32(16 * index_.size());
  for (const auto& [offset, bytes] : index_)
    words.text("00dc").u32(kKeyFrame).u32(offset).u32(bytes);
  const auto index = words.take();
  if (write_at(end_, index)) (void)write_at(0, header(index.size()));
}

}  // namespace handcast::renderer
