// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "config/rig.hpp"
#include "config/settings/settings.hpp"
#include "ipc/base/join.hpp"

namespace handcast::config {
namespace {

constexpr std::string_view kHead =
    "# Settings\n"
    "\n"
    "All settings of a rig file, generated from the declarations in `config/sections`; a test "
    "compares them.\n"
    "To update this page: `handcast config --reference > config/REFERENCE.md`.\n"
    "\n"
    "A rig file is TOML and contains only what differs from the defaults. `--set path=value` "
    "changes one setting for one run,\n"
    "for example `--set cascade.fill.method=none`. A relative path in a rig file starts at the "
    "folder of that file, a relative\n"
    "path in `--set` at the current folder. `handcast config --check FILE` lists what `handcast "
    "up` would refuse; it opens no device, output or port.\n"
    "\n"
    "Those marked (live) change while the rig is up, with `handcast set path=value`; the others "
    "when their services are started, with\n"
    "`handcast reload`.\n";

/// Escapes bars, which would end the cell of a table.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

std::string allowed_without_unit(const Setting& setting) {
  if (const auto words = setting.words(); !words.empty())
    return fmt::format("`{}`", join(words, "` `"));
  auto bare = setting;
  bare.range.unit = "";
  return print_allowed(bare);
}

std::string row(const Setting& setting) {
  return fmt::format("| `{}`{} | `{}` | {} | {} | {} |\n", setting.name(),
                     setting.effect == Effect::live ? " (live)" : "", cell(print_value(setting)),
                     allowed_without_unit(setting), cell(setting.range.unit),
                     cell(setting.sentence));
}

constexpr std::string_view kTable =
    "\n| setting | default | allowed | unit | |\n|---|---|---|---|---|\n";

std::string heading(const Section& section) {
  return fmt::format("\n## [{}]\n\n{}", section.path, section.sentence);
}

/// A section that has the settings of another one, said once: in those within it too. The table has
/// the settings with defaults of their own, and its own settings.
std::string print_as(const Section& section, const std::string& other, const Listing& listing) {
  std::string rows;
  for (const auto& each : listing) {
    if (each.path != section.path && !each.path.starts_with(section.path + ".")) continue;
    for (const auto& setting : each.settings) {
      const auto* first = find_setting(listing, name_at_first(setting.path));
      if (!first || print_value(setting) != print_value(*first)) rows += row(setting);
    }
  }
  return fmt::format("{} It has the settings and sections of [{}]{}.\n", heading(section), other,
                     rows.empty() ? "" : ", but for these") +
         (rows.empty() ? "" : std::string(kTable) + rows);
}

}  // namespace

std::string print_reference() {
  Rig defaults;
  std::string page(kHead);
  const auto listing = list_settings(defaults);
  for (const auto& section : listing) {
    if (const auto other = name_at_first(section.path); !other.empty()) {
      if (section.path.find('.') == std::string::npos) page += print_as(section, other, listing);
      continue;
    }
    page += section.path.empty() ? "\n## The file itself\n" : heading(section) + "\n";
    if (section.settings.empty()) continue;
    page += kTable;
    for (const auto& setting : section.settings) page += row(setting);
  }
  return page;
}

}  // namespace handcast::config
