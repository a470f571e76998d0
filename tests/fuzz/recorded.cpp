// SPDX-License-Identifier: Apache-2.0
// A recording of `handcast record`, read and scheduled as replay does. The input is a sequence of
// files: number of the name, length (16 bits), contents. The rows of an index get the checksums of
// their data, which chance does not find.
// Limits: 10 s and 1 GB per input.
#include <fcntl.h>
#include <libdeflate.h>

#include <array>
#include <vector>

#include "services/recording/playback.hpp"
#include "tests/fuzz/input.hpp"

namespace {

using namespace handcast;
using recording::IndexRow;
namespace fs = std::filesystem;

constexpr std::array kNames{"recording.json", "camera.frames.data", "pose.hands.data",
                            "camera.frames.index", "pose.hands.index"};
constexpr std::size_t kFirstIndex = 3;

/// A folder that is filled anew for each input.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("handcast-fuzz-" + std::to_string(getpid()))) {
    fs::create_directories(path_);
  }
  ~Folder() { fs::remove_all(path_); }

  void fill(fuzz::Reader reader) {
    std::array<std::vector<std::uint8_t>, kNames.size()> files;
    while (!reader.at_end()) {
      auto& file = files[reader.number<std::uint8_t>() % files.size()];
      const auto bytes = reader.take(reader.number<std::uint16_t>());
      file.assign(bytes.begin(), bytes.end());
    }
    for (std::size_t i = kFirstIndex; i < files.size(); ++i) seal(files[i], files[i - 2]);
    for (std::size_t i = 0; i < files.size(); ++i) {
      const int fd =
          open((path_ / kNames[i]).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
      fuzz::require(write(fd, files[i].data(), files[i].size()) ==
                    static_cast<ssize_t>(files[i].size()));
      close(fd);
    }
  }
  const fs::path& path() const { return path_; }

 private:
  static void seal(std::vector<std::uint8_t>& index, const std::vector<std::uint8_t>& data) {
    for (std::size_t at = 0; at + sizeof(IndexRow) <= index.size(); at += sizeof(IndexRow)) {
      IndexRow row;
      std::memcpy(&row, &index[at], sizeof row);
      const auto bytes = std::uint64_t{row.head_bytes} + row.image_bytes;
      if (row.offset > data.size() || bytes > data.size() - row.offset) continue;
      row.crc = libdeflate_crc32(0, data.data() + row.offset, bytes);
      std::memcpy(&index[at], &row, sizeof row);
    }
  }

  fs::path path_;
};

template <class T>
void read(const fs::path& folder, const char* stream) {
  auto reader = recording::StreamReader::open<T>(folder, stream);
  if (!reader) return;
  std::vector<std::uint8_t> pixels(64 * 64);
  for (std::size_t i = 0; i < reader->rows().size(); ++i) {
    T message;
    if (reader->read(i, message, pixels)) fuzz::require(recording::is_sound(message));
  }
  const auto schedule = recording::Schedule::make(folder, *reader, 1'000'000'000, true);
  if (!schedule) return;
  std::int64_t time_ns = 0;
  for (int i = 0; i < 10; ++i) {
    const auto item = schedule->at_or_after(time_ns);
    fuzz::require(item && item->index < reader->rows().size() && item->due_ns >= time_ns);
    time_ns = item->due_ns + 1;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Folder folder;
  folder.fill(fuzz::Reader({data, size}));
  read<msg::CameraFrame>(folder.path(), "camera.frames");
  read<msg::HandPoses>(folder.path(), "pose.hands");
  return 0;
}
