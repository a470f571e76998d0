// SPDX-License-Identifier: Apache-2.0
#include "services/calibrate/rig_file_edit.hpp"

#include <fmt/format.h>

#include <sstream>
#include <vector>

#include "config/rig.hpp"
#include "config/settings/files.hpp"
#include "services/calibrate/kept_file.hpp"

namespace handcast::calibrate {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// What a line says: without its comment and without spaces.
std::string meaning_of(const std::string& line) {
  std::string meaning;
  for (const char c : line) {
    if (c == '#') break;
    if (c != ' ' && c != '\t' && c != '\r') meaning += c;
  }
  return meaning;
}

/// The line with another value, its comment kept. The values of these settings are numbers.
std::string with_value(const std::string& line, const std::string& value) {
  const auto equals = line.find('='), comment = line.find('#');
  return line.substr(0, equals + 1) + " " + value +
         (comment == std::string::npos ? "" : "  " + line.substr(comment));
}

}  // namespace

std::string with_setting(const std::string& text, const MeasuredSetting& setting) {
  const auto dot = setting.path.rfind('.');
  const auto section = setting.path.substr(0, dot), key = setting.path.substr(dot + 1);
  auto lines = lines_of(text);
  std::string here;
  std::size_t header = lines.size();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto meaning = meaning_of(lines[i]);
    if (meaning.starts_with("[")) {
      here = meaning;
      if (here == "[" + section + "]") header = i;
    }
    const bool is_it = (here == "[" + section + "]" && meaning.starts_with(key + "=")) ||
                       (here.empty() && meaning.starts_with(setting.path + "="));
    if (!is_it) continue;
    lines[i] = with_value(lines[i], setting.value);
    return fmt::format("{}\n", fmt::join(lines, "\n"));
  }
  const auto line = fmt::format("{} = {}", key, setting.value);
  if (header < lines.size())
    lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(header) + 1, line);
  else
    lines.insert(lines.end(), {"", "[" + section + "]", line});
  return fmt::format("{}\n", fmt::join(lines, "\n"));
}

Result<std::string> apply_settings(const std::filesystem::path& rig_file,
                                   std::span<const MeasuredSetting> settings) {
  auto text = config::read_text(rig_file);
  if (!text) return tl::make_unexpected(text.error());
  for (const auto& setting : settings) *text = with_setting(*text, setting);
  // Beside the file, because paths in it are relative to its folder.
  auto tried = rig_file;
  tried += ".new.toml";
  std::error_code ignored;
  auto written = config::write_whole(tried, *text);
  const auto rig = written ? config::load_rig(tried, {}) : Result<config::Rig>();
  std::filesystem::remove(tried, ignored);
  if (!written) return tl::make_unexpected(written.error());
  if (!rig)
    return fail_in(fmt::format("the settings cannot be written to {}", rig_file.string()),
                   rig.error());
  const auto old = keep_old(rig_file);
  if (!old) return tl::make_unexpected(old.error());
  written = config::write_whole(rig_file, *text);
  return written.map([&] {
    return fmt::format("{} has these settings now; the one before it is kept as {}",
                       rig_file.string(), old->filename().string());
  });
}

}  // namespace handcast::calibrate
