// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fstream>
#include <limits>
#include <utility>

#include "ipc/base/clock.hpp"
#include "services/desk/page/programs.hpp"
#include "services/recording/about.hpp"
#include "services/recording/index_row.hpp"

namespace handcast::desk {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostRecordings = 200;

/// When the first and the last message of a stream were published, of its index alone.
std::pair<std::int64_t, std::int64_t> span_ns(const fs::path& index, std::uintmax_t bytes) {
  constexpr std::uintmax_t kRow = sizeof(recording::IndexRow);
  std::pair span{std::numeric_limits<std::int64_t>::max(), std::int64_t{0}};
  std::ifstream file(index, std::ios::binary);
  recording::IndexRow row;
  if (bytes < kRow || !file.read(reinterpret_cast<char*>(&row), kRow)) return span;
  span.first = row.published_ns;
  file.seekg(static_cast<std::streamoff>((bytes / kRow - 1) * kRow));
  if (file.read(reinterpret_cast<char*>(&row), kRow)) span.second = row.published_ns;
  return span;
}

Recording look_at(const fs::path& folder) {
  Recording found{.name = folder.filename().string(), .seconds = 0, .bytes = 0};
  auto first_ns = std::numeric_limits<std::int64_t>::max();
  std::int64_t last_ns = 0;
  std::error_code gone;
  for (const auto& file : fs::directory_iterator(folder, gone)) {
    std::error_code odd;
    const auto bytes = file.file_size(odd);
    if (odd) continue;
    found.bytes += bytes;
    if (file.path().extension() != ".index") continue;
    const auto [from_ns, to_ns] = span_ns(file.path(), bytes);
    first_ns = std::min(first_ns, from_ns);
    last_ns = std::max(last_ns, to_ns);
  }
  if (last_ns > first_ns) found.seconds = ns_to_seconds(last_ns - first_ns);
  return found;
}

}  // namespace

std::vector<Recording> recordings_in(const fs::path& folder) {
  std::vector<std::pair<fs::file_time_type, fs::path>> folders;
  std::error_code absent;
  for (const auto& each : fs::directory_iterator(folder, absent))
    if (recording::is_recording(each.path()))
      folders.emplace_back(each.last_write_time(absent), each.path());
  std::ranges::sort(folders, std::greater());
  if (folders.size() > kMostRecordings) folders.resize(kMostRecordings);
  std::vector<Recording> all;
  all.reserve(folders.size());
  for (const auto& [when, path] : folders) all.push_back(look_at(path));
  return all;
}

}  // namespace handcast::desk
