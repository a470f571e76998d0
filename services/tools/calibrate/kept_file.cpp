// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/kept_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <ctime>
#include <functional>
#include <string_view>
#include <system_error>
#include <vector>

#include "config/settings/files.hpp"
#include "ipc/base/write_whole.hpp"

namespace handcast::calibrate {
namespace {

namespace fs = std::filesystem;

fs::path in_folder(const fs::path& file, const std::string& stem) {
  return file.parent_path() / (stem + file.extension().string());
}

constexpr std::string_view kTime = "-dddd-dd-ddTddddddZ";  ///< in a name; d: a digit

std::string text_of(const char* format, const std::tm& time) {
  std::array<char, 64> text{};
  return {text.data(), std::strftime(text.data(), text.size(), format, &time)};
}

/// The time in the names of kept files, for people.
std::string universal_time() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  return text_of("-%Y-%m-%dT%H%M%SZ", utc);
}

/// The number of a file, if it is STEM.NUMBER-TIME.EXTENSION of `file`; else 0.
int number_of(const fs::path& file, const fs::path& other) {
  const auto stem = file.stem().string() + ".";
  const auto name = other.stem().string();
  std::error_code unknown;
  if (other.extension() != file.extension() || !name.starts_with(stem) ||
      name.size() <= stem.size() + kTime.size() || !fs::is_regular_file(other, unknown))
    return 0;
  const auto time = name.size() - kTime.size();
  const bool has_time = std::equal(
      kTime.begin(), kTime.end(), name.begin() + std::ptrdiff_t(time),
      [](char kind, unsigned char c) { return kind == 'd' ? std::isdigit(c) != 0 : kind == c; });
  int number = 0;
  const auto [end, error] = std::from_chars(name.data() + stem.size(), name.data() + time, number);
  return has_time && error == std::errc{} && end == name.data() + time ? std::max(number, 0) : 0;
}

/// The kept files, the newest first: by their numbers, because clocks go back.
std::vector<fs::path> all_kept(const fs::path& file) {
  std::vector<fs::path> kept;
  if (file.empty()) return kept;  // the built-in calibration
  std::error_code unknown;
  for (const auto& entry : fs::directory_iterator(fs::absolute(file).parent_path(), unknown))
    if (number_of(file, entry.path()) > 0) kept.push_back(entry.path());
  std::ranges::sort(kept, std::greater<>(),
                    [&](const fs::path& path) { return number_of(file, path); });
  return kept;
}

/// The name that the next version gets.
fs::path free_name_of(const fs::path& file, int above) {
  const int number = std::max(newest_number({file}), above) + 1;
  return in_folder(file, fmt::format("{}.{:04}{}", file.stem().string(), number, universal_time()));
}

/// Copies a file to a free name, which it returns.
Result<fs::path> keep_old(const fs::path& file, int above) {
  const auto old = free_name_of(file, above);
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
  return text_of(format, local);
}

Result<std::string> write_and_keep(const fs::path& file, const std::string& text, int above) {
  std::string sentence = file.string();
  std::error_code unknown;
  if (fs::exists(file, unknown)) {
    const auto old = keep_old(file, above);
    if (!old) return tl::make_unexpected(old.error());
    sentence += fmt::format("; the one before it is kept as {}", old->filename().string());
  }
  return write_whole(file, text).map([&] { return sentence; });
}

int newest_number(std::initializer_list<fs::path> files) {
  int newest = 0;
  for (const auto& file : files)
    if (const auto kept = all_kept(file); !kept.empty())
      newest = std::max(newest, number_of(file, kept.front()));
  return newest;
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
