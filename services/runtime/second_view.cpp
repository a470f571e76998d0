// SPDX-License-Identifier: Apache-2.0
#include "services/runtime/second_view.hpp"

#include <cctype>
#include <set>

#include "config/rig.hpp"
#include "config/settings/settings.hpp"

namespace handcast::service {
namespace {

constexpr std::string_view kInNames = "abcdefghijklmnopqrstuvwxyz0123456789_.";

/// The settings and sections of a rig, and the streams of both views.
std::set<std::string, std::less<>> list_names() {
  std::set<std::string, std::less<>> names{"camera.frames", "landmarks.hands"};
  config::Rig rig;
  for (const auto& section : config::list_settings(rig)) {
    names.insert(section.path);
    for (const auto& setting : section.settings) names.insert(setting.path);
  }
  return names;
}

/// Whether what follows the name of a service, of `length` letters at the begin of `rest`, makes it
/// one that the second view has under another name.
bool is_renamed(std::string_view rest, std::size_t length, bool at_begin) {
  static const auto kNames = list_names();
  const auto after = rest.substr(length);
  if (at_begin && (after.starts_with(" '") || after.starts_with(": "))) return true;
  if (!after.starts_with('.')) return false;
  auto name = rest.substr(0, rest.find_first_not_of(kInNames));
  while (name.ends_with('.')) name.remove_suffix(1);
  return name.size() > length && kNames.contains(name);
}

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
         std::string_view("_./-").find(c) != std::string_view::npos;
}

}  // namespace

std::string in_second_view(std::string_view sentence) {
  std::string renamed;
  for (std::size_t i = 0; i < sentence.size(); ++i) {
    renamed += sentence[i];
    if (i > 0 && is_word(sentence[i - 1])) continue;
    for (const std::string_view service : {"camera", "landmarks"}) {
      const auto rest = sentence.substr(i);
      if (!rest.starts_with(service) || !is_renamed(rest, service.size(), i == 0)) continue;
      renamed += std::string(service.substr(1)) + "2";
      i += service.size() - 1;
      break;
    }
  }
  return renamed;
}

std::string of_second_view(std::string_view name) {
  for (const std::string_view section : {"camera", "landmarks"})
    if (name == section ||
        (name.starts_with(section) && name.substr(section.size()).starts_with('.')))
      return std::string(section) + "2" + std::string(name.substr(section.size()));
  return std::string(name);
}

daemon::ServiceDescription of_second_view(daemon::ServiceDescription description) {
  const auto rename = [](std::vector<std::string>& names) {
    for (auto& name : names) name = of_second_view(name);
  };
  description.is_second_view = true;
  description.name = of_second_view(description.name);
  description.summary = "Of the second camera: " + description.summary;
  description.paced_by = of_second_view(description.paced_by);
  rename(description.publishes);
  rename(description.subscribes);
  rename(description.settings);
  for (auto& backend : description.backends) rename(backend.settings);
  return description;
}

}  // namespace handcast::service
