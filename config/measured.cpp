// SPDX-License-Identifier: Apache-2.0
#include "config/measured.hpp"

#include <fmt/format.h>

#include "config/rig.hpp"
#include "config/settings/files.hpp"
#include "config/settings/load.hpp"

namespace handcast::config {
namespace {

/// Adds the settings of a document that was applied to `listing`.
void add_settings(const Table& table, const std::string& section, const Listing& listing,
                  std::vector<MeasuredSetting>& settings) {
  for (const auto& [name, value] : table) {
    const auto path = section.empty() ? name : section + "." + name;
    if (const auto* setting = find_setting(listing, path))
      settings.push_back({path, print_value(*setting)});
    else if (const auto* inner = std::get_if<Table>(&value.data))
      add_settings(*inner, path, listing, settings);
  }
}

}  // namespace

std::filesystem::path measured_file_of(const std::filesystem::path& rig_file) {
  return std::filesystem::path(rig_file).replace_extension(".measured.toml");
}

Result<std::vector<MeasuredSetting>> parse_measured(const std::string& toml,
                                                    const std::filesystem::path& file) {
  const auto document = parse_document(toml, file.string());
  if (!document) return tl::make_unexpected(document.error());
  Rig rig;
  const auto listing = list_settings(rig);
  Faults faults;
  apply_document(*document, file.string(), listing, faults);
  if (!faults.empty()) return tl::make_unexpected(faults.to_error());
  std::vector<MeasuredSetting> settings;
  add_settings(std::get<Table>(document->data), "", listing, settings);
  return settings;
}

Result<std::vector<MeasuredSetting>> read_measured(const std::filesystem::path& file) {
  std::error_code unknown;
  if (!std::filesystem::exists(file, unknown)) return {};
  const auto text = read_text(file);
  if (!text) return tl::make_unexpected(text.error());
  return parse_measured(*text, file);
}

std::string print_measured(std::span<const MeasuredSetting> settings) {
  std::string text;
  for (const auto& [path, value] : settings) text += fmt::format("{} = {}\n", path, value);
  return text;
}

}  // namespace handcast::config
