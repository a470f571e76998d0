// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/rig_file_edit.hpp"

#include <fmt/format.h>

#include "config/rig.hpp"
#include "config/settings/edit.hpp"
#include "config/settings/files.hpp"
#include "config/settings/quoted.hpp"
#include "ipc/base/write_whole.hpp"
#include "services/tools/calibrate/kept_file.hpp"

namespace handcast::calibrate {
namespace {

/// As --set takes it: relative paths start elsewhere there.
std::string as_assignment(const MeasuredSetting& setting, const std::filesystem::path& rig_file) {
  const auto value =
      config::names_a_file(setting.path)
          ? (std::filesystem::absolute(rig_file).parent_path() / setting.value).string()
          : setting.value;
  return fmt::format("{}={}", setting.path, value);
}

/// The new text must be the rig that the old one is with --set.
Result<void> check_edit(const std::filesystem::path& rig_file, const std::string& before,
                        const std::string& after, const MeasuredSetting& setting) {
  const auto expected = config::parse_rig(before, rig_file, {as_assignment(setting, rig_file)});
  if (!expected) return tl::make_unexpected(expected.error());
  const auto rig = config::parse_rig(after, rig_file);
  if (!rig) return tl::make_unexpected(rig.error());
  if (config::print_rig(*rig) == config::print_rig(*expected)) return {};
  return fail(Errc::bad_config,
              fmt::format("{}: more than {} would change; write by hand: {} = {}",
                          rig_file.string(), setting.path, setting.path, as_toml(setting)));
}

Result<std::string> edited(const std::filesystem::path& rig_file, std::string text,
                           std::span<const MeasuredSetting> settings) {
  for (const auto& setting : settings) {
    auto after = config::with_value(text, setting.path, as_toml(setting), rig_file.string());
    if (!after) return after;
    if (auto good = check_edit(rig_file, text, *after, setting); !good)
      return tl::make_unexpected(good.error());
    text = std::move(*after);
  }
  return text;
}

}  // namespace

std::string as_toml(const MeasuredSetting& setting) {
  return config::names_a_file(setting.path) ? config::quoted(setting.value) : setting.value;
}

Result<std::string> apply_settings(const std::filesystem::path& rig_file,
                                   std::span<const MeasuredSetting> settings) {
  const auto before = config::read_text(rig_file);
  if (!before) return tl::make_unexpected(before.error());
  const auto text = edited(rig_file, *before, settings);
  if (!text)
    return fail_in(fmt::format("the settings cannot be written to {}", rig_file.string()),
                   text.error());
  if (*text == *before) return fmt::format("{} has these settings already", rig_file.string());
  const auto old = keep_old(rig_file);
  if (!old) return tl::make_unexpected(old.error());
  return write_whole(rig_file, *text).map([&] {
    return fmt::format("{} has these settings now; the one before it is kept as {}",
                       rig_file.string(), old->filename().string());
  });
}

}  // namespace handcast::calibrate
