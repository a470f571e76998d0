// SPDX-License-Identifier: Apache-2.0
#include "supervisor/spec/idle_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "config/second_view.hpp"
#include "config/settings/settings.hpp"
#include "ipc/base/join.hpp"
#include "supervisor/spec/service_spec.hpp"

namespace handcast::supervisor {
namespace {

bool is_part_of(std::string_view path, std::string_view section) {
  return path == section ||
         (path.starts_with(section) && path.substr(section.size()).starts_with('.'));
}

/// The back ends that a service may use: its own, one beside it, and its fallback.
std::set<std::string> chosen_for(const std::string& service, const config::Listing& listing) {
  std::set<std::string> names;
  for (const auto* name : {"backend", "second", "fallback"})
    if (const auto* setting = config::find_setting(listing, service + "." + name))
      names.insert(*std::get<std::string*>(setting->target));
  return names;
}

/// Whom a rig has, and what they read.
class Readers {
 public:
  Readers(const config::Rig& rig, const config::Listing& listing, const Catalogue& catalogue)
      : rig_(rig), catalogue_(catalogue) {
    for (const auto& [service, description] : catalogue)
      chosen_[service] = chosen_for(service, listing);
    for (const auto& service : services_of(rig, catalogue)) active_.insert(service.name);
  }

  /// Why nobody reads a setting; "" if somebody does.
  std::string why_idle(std::string_view path) const {
    for (const auto& [service, description] : catalogue_) {
      if (!path.starts_with(service + ".")) continue;
      if (path == service + ".backend" || path == service + ".enabled") return {};
      if (!active_.contains(service)) return why_absent(service);
      if (is_read_by_another(path, service)) return {};
      if (is_part_of(path, "pose.handover") && rig_.pose.second.empty())
        return "pose.second is empty";
      if (is_of_another_backend(path, description))
        return fmt::format("{}.backend is \"{}\"", service, backend_of(service));
    }
    return {};
  }

  /// The service that a setting belongs to.
  std::string service_of(std::string_view path) const {
    return std::string(path.substr(0, path.find('.')));
  }

 private:
  std::string backend_of(const std::string& service) const {
    auto copy = rig_;
    const auto* setting = config::find_setting(config::list_settings(copy), service + ".backend");
    return setting ? *std::get<std::string*>(setting->target) : "";
  }

  std::string why_absent(const std::string& service) const {
    if (service == "observer") return "observer.enabled is false";
    if (service == "landmarks2") return "the rig has no second camera";
    return fmt::format("{}.backend is \"none\"", service);
  }

  /// Whether it is what one back end of the service reads, and not one that is chosen.
  bool is_of_another_backend(std::string_view path,
                             const daemon::ServiceDescription& description) const {
    bool is_anothers = false;
    const auto& chosen = chosen_.at(description.name);
    for (const auto& backend : description.backends) {
      const auto own_section = fmt::format("{}.{}", description.name, backend.name);
      const bool reads = is_part_of(path, own_section) ||
                         std::ranges::any_of(backend.settings, [&](const auto& section) {
                           return is_part_of(path, section);
                         });
      if (reads && chosen.contains(backend.name)) return false;
      is_anothers = is_anothers || reads;
    }
    return is_anothers;
  }

  bool is_read_by_another(std::string_view path, const std::string& than) const {
    const auto reads = [&](const std::vector<std::string>& sections) {
      return std::ranges::any_of(sections,
                                 [&](const auto& section) { return is_part_of(path, section); });
    };
    return std::ranges::any_of(active_, [&](const std::string& service) {
      const auto found = catalogue_.find(service);
      if (service == than || found == catalogue_.end()) return false;
      return reads(found->second.settings) ||
             std::ranges::any_of(found->second.backends, [&](const auto& backend) {
               return chosen_.at(service).contains(backend.name) && reads(backend.settings);
             });
    });
  }

  const config::Rig& rig_;
  const Catalogue& catalogue_;
  std::map<std::string, std::set<std::string>> chosen_;  ///< by service
  std::set<std::string> active_;                         ///< services of the rig
};

}  // namespace

std::vector<std::string> idle_settings(const config::Rig& rig, const Catalogue& catalogue,
                                       const std::vector<std::string>& settings) {
  auto copy = rig;
  config::Rig usual;
  const auto listing = config::list_settings(copy), defaults = config::list_settings(usual);
  const Readers readers(rig, listing, catalogue);
  const auto is_tried = [&](const std::string& service) {
    return std::ranges::any_of(settings, [&](const std::string& assignment) {
      return assignment.starts_with(service + ".backend=");
    });
  };
  std::map<std::string, std::vector<std::string>> idle;  // by reason
  for (const auto& section : listing)
    for (const auto& setting : section.settings) {
      if (config::print_value(setting) ==
          config::print_value(*config::find_setting(defaults, setting.path)))
        continue;
      const auto why = readers.why_idle(setting.path);
      if (!why.empty() && !is_tried(readers.service_of(setting.path)))
        idle[why].push_back(setting.path);
    }
  std::vector<std::string> sentences;
  for (const auto& [why, paths] : idle)
    sentences.push_back(fmt::format("{} {} no effect, because {}", join(paths, ", "),
                                    paths.size() == 1 ? "has" : "have", why));
  return sentences;
}

}  // namespace handcast::supervisor
