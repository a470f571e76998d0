// SPDX-License-Identifier: Apache-2.0
#include "services/calibrate/kept_file.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

#include "config/settings/files.hpp"

namespace handcast::calibrate {
namespace {

namespace fs = std::filesystem;

fs::path in_folder(const fs::path& file, const std::string& stem) {
  return file.parent_path() / (stem + file.extension().string());
}

/// A name that is free: with a number if several files are kept within a second.
fs::path free_name_of(const fs::path& file) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  const auto stem = fmt::format("{}.{:%Y-%m-%dT%H%M%S}", file.stem().string(), local);
  auto name = in_folder(file, stem);
  for (int number = 2; fs::exists(name); ++number)
    name = in_folder(file, fmt::format("{}.{}", stem, number));
  return name;
}

/// Whether this is STEM.TIME.EXTENSION of the file.
bool is_kept_of(const fs::path& file, const fs::path& other) {
  constexpr std::size_t kTime = 17;  // 2026-01-31T120000
  const auto name = other.stem().string(), stem = file.stem().string() + ".";
  return other.extension() == file.extension() && name.starts_with(stem) &&
         name.size() >= stem.size() + kTime && name.find('T', stem.size()) == stem.size() + 10;
}

/// The kept file with the last name, which is the newest; empty if there is none.
fs::path newest_kept(const fs::path& file) {
  fs::path newest;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(file.parent_path(), error))
    if (is_kept_of(file, entry.path()) && entry.path().stem() > newest.stem())
      newest = entry.path();
  return newest;
}

}  // namespace

Result<fs::path> keep_old(const fs::path& file) {
  const auto old = free_name_of(file);
  std::error_code error;
  fs::copy_file(file, old, error);
  if (error)
    return fail(Errc::unavailable,
                fmt::format("the old {} cannot be copied to {}: {}", file.filename().string(),
                            old.string(), error.message()));
  return old;
}

Result<std::string> write_and_keep(const fs::path& file, const std::string& text) {
  std::string sentence = fmt::format("the calibration is in {}", file.string());
  if (fs::exists(file)) {
    const auto old = keep_old(file);
    if (!old) return tl::make_unexpected(old.error());
    sentence += fmt::format("; the one before it is kept as {}", old->filename().string());
  }
  return config::write_whole(file, text).map([&] { return sentence; });
}

Result<std::string> take_back(const fs::path& file) {
  const auto kept = newest_kept(file);
  if (kept.empty())
    return fail(Errc::bad_config,
                fmt::format("no earlier calibration is kept beside {}", file.string()));
  const auto text = config::read_text(kept);
  if (!text) return tl::make_unexpected(text.error());
  auto written = write_and_keep(file, *text);
  if (!written) return written;
  std::error_code error;
  fs::remove(kept, error);
  return fmt::format("{} is again as it was in {}", file.string(), kept.filename().string());
}

}  // namespace handcast::calibrate
