// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/kept_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <ctime>
#include <functional>
#include <string_view>
#include <tuple>
#include <vector>

#include "config/settings/files.hpp"
#include "ipc/base/write_whole.hpp"

namespace handcast::calibrate {
namespace {

namespace fs = std::filesystem;

fs::path in_folder(const fs::path& file, const std::string& stem) {
  return file.parent_path() / (stem + file.extension().string());
}

/// Of the first file that this process keeps: what it changes is taken back together.
const std::string& time_in_names() {
  static const std::string text = local_time("%Y-%m-%dT%H%M%S");
  return text;
}

/// A name that is free: with a number if a process keeps several versions.
fs::path free_name_of(const fs::path& file) {
  const auto stem = fmt::format("{}.{}", file.stem().string(), time_in_names());
  auto name = in_folder(file, stem);
  std::error_code unknown;
  for (int number = 2; fs::exists(name, unknown); ++number)
    name = in_folder(file, fmt::format("{}.{}", stem, number));
  return name;
}

constexpr std::string_view kTime = "dddd-dd-ddTdddddd";  ///< in a name; d: a digit

/// Whether this is STEM.TIME.EXTENSION of the file, with a number behind the time or without.
bool is_kept_of(const fs::path& file, const fs::path& other) {
  const auto stem = file.stem().string() + ".";
  auto name = other.stem().string();
  std::error_code unknown;
  if (other.extension() != file.extension() || !name.starts_with(stem) ||
      !fs::is_regular_file(other, unknown))
    return false;
  name.erase(0, stem.size());
  const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
  const bool has_time =
      name.size() >= kTime.size() &&
      std::equal(kTime.begin(), kTime.end(), name.begin(),
                 [&](char kind, char c) { return kind == 'd' ? is_digit(c) : kind == c; });
  if (!has_time) return false;
  name.erase(0, kTime.size());
  return name.empty() ||
         (name.size() > 1 && name[0] == '.' && std::all_of(name.begin() + 1, name.end(), is_digit));
}

/// The kept files, the newest first: by their names.
std::vector<fs::path> all_kept(const fs::path& file) {
  std::vector<fs::path> kept;
  std::error_code unknown;
  for (const auto& entry : fs::directory_iterator(file.parent_path(), unknown))
    if (is_kept_of(file, entry.path())) kept.push_back(entry.path());
  // Those of one time by their numbers: "...00" before "...00.2" before "...00.10".
  const auto second = file.stem().string().size() + 1 + kTime.size();
  std::ranges::sort(kept, std::greater<>(), [second](const fs::path& path) {
    const auto stem = path.stem().string();
    return std::tuple(stem.substr(0, second), stem.size(), stem);
  });
  return kept;
}

/// Copies a file to a free name, which it returns.
Result<fs::path> keep_old(const fs::path& file) {
  const auto old = free_name_of(file);
  std::error_code error;
  fs::copy_file(file, old, error);
  if (error && error != std::errc::file_exists) {
    std::error_code absent;
    fs::remove(old, absent);  // a part of it, on a full disk
  }
  if (error)
    return fail(Errc::unavailable,
                fmt::format("the old {} cannot be copied to {}: {}", file.filename().string(),
                            old.string(), error.message()));
  return old;
}

}  // namespace

std::string local_time(const char* format) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  std::array<char, 64> text{};
  return {text.data(), std::strftime(text.data(), text.size(), format, &local)};
}

Result<std::string> write_and_keep(const fs::path& file, const std::string& text) {
  std::string sentence = file.string();
  std::error_code unknown;
  if (fs::exists(file, unknown)) {
    const auto old = keep_old(file);
    if (!old) return tl::make_unexpected(old.error());
    sentence += fmt::format("; the one before it is kept as {}", old->filename().string());
  }
  return write_whole(file, text).map([&] { return sentence; });
}

std::string newest_time(const fs::path& file) {
  const auto kept = all_kept(file);
  if (kept.empty()) return {};
  return kept.front().stem().string().substr(file.stem().string().size() + 1, kTime.size());
}

Result<std::string> take_back(const fs::path& file, const IsUsable& is_usable) {
  std::string faults;
  for (const auto& kept : all_kept(file)) {
    if (const auto usable = is_usable(kept); !usable) {
      faults += fmt::format("; {}", usable.error().what);
      continue;
    }
    const auto text = config::read_text(kept);
    if (!text) return tl::make_unexpected(text.error());
    if (auto written = write_and_keep(file, *text); !written) return written;
    std::error_code unknown;
    fs::remove(kept, unknown);
    return fmt::format("{} is again as it was in {}{}", file.string(), kept.filename().string(),
                       faults);
  }
  return fail(Errc::bad_config,
              fmt::format("no earlier calibration is kept beside {}{}", file.string(), faults));
}

}  // namespace handcast::calibrate
