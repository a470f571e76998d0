// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/kept_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>

#include "ipc/base/log.hpp"
#include "ipc/base/write_whole.hpp"

namespace handcast::calibrate {
namespace {

constexpr std::string_view kEquals = " = ";
constexpr std::size_t kMost_bytes = 2000;  ///< a step measures one setting or two

bool is_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

bool is_path(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '.';
  });
}

std::optional<MeasuredSetting> setting_of(std::string_view line) {
  const auto equals = line.find(kEquals);
  if (equals == std::string_view::npos) return {};
  const auto path = line.substr(0, equals), value = line.substr(equals + kEquals.size());
  if (!is_path(path) || !is_number(value)) return {};
  return MeasuredSetting{std::string(path), std::string(value)};
}

std::vector<MeasuredSetting> ignored(const std::filesystem::path& file) {
  fmt::print(stderr, "  {} holds no measured settings, and is ignored: measure that step again\n",
             printable(file.string()));
  return {};
}

}  // namespace

std::vector<MeasuredSetting> read_settings(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return {};
  if (!std::filesystem::is_regular_file(file, error)) return ignored(file);
  std::array<char, kMost_bytes + 1> bytes{};
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), bytes.size());
  const auto size = static_cast<std::size_t>(in.gcount());
  if (size == 0 || size > kMost_bytes) return ignored(file);
  std::istringstream text(std::string(bytes.data(), size));
  std::vector<MeasuredSetting> settings;
  for (std::string line; std::getline(text, line);) {
    auto setting = setting_of(line);
    if (!setting) return ignored(file);
    settings.push_back(std::move(*setting));
  }
  return settings;
}

Result<void> write_settings(const std::filesystem::path& file,
                            std::span<const MeasuredSetting> settings) {
  if (settings.empty()) {
    std::error_code absent;
    std::filesystem::remove(file, absent);
    return {};
  }
  std::string text;
  for (const auto& setting : settings)
    text += fmt::format("{}{}{}\n", setting.path, kEquals, setting.value);
  return write_whole(file, text);
}

}  // namespace handcast::calibrate
