// SPDX-License-Identifier: Apache-2.0
#include "config/live/live_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

#include "config/measured.hpp"
#include "config/settings/file_kind.hpp"
#include "config/settings/load.hpp"
#include "config/settings/settings.hpp"
#include "ipc/base/quote.hpp"

namespace handcast::config {
namespace {

constexpr char kEnd = '\f';  ///< of the values of one change; a TOML text has it escaped
constexpr std::int64_t kOneChange_ns = 1'000'000'000;
constexpr std::string_view kWhere = "live settings";

/// The setting that an assignment or a line of values names.
std::string_view path_in(std::string_view assignment) {
  auto path = assignment.substr(0, assignment.find('='));
  while (path.ends_with(' ')) path.remove_suffix(1);
  return path;
}

/// The settings in a text "path = value, path = value".
std::string paths_in(std::string_view change) {
  std::string paths;
  while (!change.empty()) {
    paths += fmt::format("{} ", path_in(change));
    const auto next = std::min(change.find(", "), change.size());
    change.remove_prefix(std::min(next + 2, change.size()));
  }
  return paths;
}

/// Whether a person may change this setting while the rig is up; adds a fault if not.
bool check_live(const Listing& listing, std::string_view path, Faults& faults) {
  const auto* setting = find_setting(listing, path);
  if (!setting) return true;  // load.hpp has the sentence
  if (setting->effect == Effect::live) return true;
  faults.add(fmt::format(
      "{}: takes effect when its service is started: write it into the rig file and run `handcast "
      "reload`",
      path));
  return false;
}

/// Removes the lines of these settings.
std::string without(std::string_view values, const std::set<std::string_view>& paths) {
  std::string left;
  while (!values.empty()) {
    const auto line = values.substr(0, values.find('\n'));
    if (!paths.contains(path_in(line))) left += fmt::format("{}\n", line);
    values.remove_prefix(std::min(values.size(), line.size() + 1));
  }
  return left;
}

/// The live values of `rig` that are not those of the file.
std::string differences(const Rig& filed, const Rig& rig) {
  auto before = filed, now = rig;
  const auto old_listing = list_settings(before), listing = list_settings(now);
  std::string values;
  for (std::size_t s = 0; s < listing.size(); ++s)
    for (std::size_t i = 0; i < listing[s].settings.size(); ++i) {
      const auto& setting = listing[s].settings[i];
      if (setting.effect != Effect::live) continue;
      const auto value = print_value(setting);
      if (value != print_value(old_listing[s].settings[i]))
        values += fmt::format("{} = {}\n", setting.path, value);
    }
  return values;
}

/// What only a simulator can do.
Result<void> check_possible(const Rig& rig) {
  if (rig.cascade.filter.method == FilterMethod::ideal)
    return fail(Errc::bad_config,
                "cascade.filter.method: ideal needs the true landmarks, which only `handcast "
                "simulate` has");
  return {};
}

/// The differences of a rig that is possible, if they can be read again.
Result<std::string> values_to_keep(const Rig& filed, const Rig& rig) {
  if (const auto possible = check_possible(rig); !possible)
    return tl::make_unexpected(possible.error());
  auto values = differences(filed, rig);
  if (auto why = why_unreadable(values); !why.empty())
    return fail(Errc::bad_config, std::move(why));
  return values;
}

/// Adds the values of a step, and drops the oldest steps if there is no room.
template <std::size_t N>
void push(msg::MessageText<N>& steps, std::string_view values) {
  auto text = fmt::format("{}{}{}", steps.view(), values, kEnd);
  while (text.size() >= N && text.find(kEnd) != text.npos) text.erase(0, text.find(kEnd) + 1);
  steps.set(text);
}

/// Takes the newest step out; false if there is none.
template <std::size_t N>
bool pop(msg::MessageText<N>& steps, std::string& values) {
  std::string text(steps.view());
  if (text.empty()) return false;
  text.pop_back();
  const auto at = text.rfind(kEnd);
  const auto begin = at == text.npos ? 0 : at + 1;
  values = text.substr(begin);
  text.erase(begin);
  steps.set(text);
  return true;
}

}  // namespace

Result<Rig> with_live(const Rig& filed, std::string_view values) {
  return change_rig(filed, {std::string(kWhere), std::string(values)}, {});
}

Result<std::string> changed_values(const Rig& filed, std::string_view values,
                                   std::span<const std::string> assignments) {
  auto scratch = filed;
  const auto listing = list_settings(scratch);
  Faults faults;
  std::set<std::string_view> paths;
  std::vector<std::string> set;
  for (const auto& assignment : assignments) {
    const auto path = path_in(assignment);
    const bool is_reset = assignment.find('=') == assignment.npos;
    if (!check_live(listing, path, faults)) continue;
    if (is_reset && !find_setting(listing, path))
      faults.add(fmt::format("{} is not a setting; `handcast get` lists those that can be changed",
                             quote(path)));
    paths.insert(path);
    if (!is_reset) set.push_back(assignment);
  }
  if (!faults.empty()) return tl::make_unexpected(faults.to_error());
  const auto rig = change_rig(filed, {std::string(kWhere), without(values, paths)}, set);
  if (!rig) return tl::make_unexpected(rig.error());
  return values_to_keep(filed, *rig);
}

Result<std::string> values_of_preset(const Rig& filed, const std::string& toml,
                                     std::string_view file) {
  return change_rig(filed, {std::string(file), toml}, {}).and_then([&](const Rig& rig) {
    return values_to_keep(filed, rig);
  });
}

Result<void> change(msg::LiveSettings& settings, std::string_view values, std::string_view what,
                    std::string_view source, std::int64_t now_ns) {
  constexpr std::size_t kForLight = 512;  // a blackout must always be possible
  const auto room = settings.values.bytes.size() - (what.starts_with("light.") ? 0 : kForLight);
  if (values.size() >= room)
    return fail(Errc::bad_config,
                fmt::format("more than {} bytes of changed settings; take some back, or write them "
                            "into the rig file",
                            room - 1));
  const bool goes_on =
      settings.source.view() == source && paths_in(settings.change.view()) == paths_in(what) &&
      now_ns - settings.header.origin_ns < kOneChange_ns && !settings.undo.view().empty();
  if (!goes_on) push(settings.undo, settings.values.view());
  settings.redo.set("");
  settings.values.set(values);
  settings.change.set(what);
  settings.source.set(source);
  return {};
}

Result<void> undo(msg::LiveSettings& settings, std::string_view source) {
  std::string before;
  if (!pop(settings.undo, before)) return fail(Errc::bad_config, "there is no change to take back");
  push(settings.redo, settings.values.view());
  settings.values.set(before);
  settings.change.set("undo");
  settings.source.set(source);
  return {};
}

Result<void> redo(msg::LiveSettings& settings, std::string_view source) {
  std::string after;
  if (!pop(settings.redo, after)) return fail(Errc::bad_config, "there is no change to do again");
  push(settings.undo, settings.values.view());
  settings.values.set(after);
  settings.change.set("redo");
  settings.source.set(source);
  return {};
}

}  // namespace handcast::config
