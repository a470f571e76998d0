// SPDX-License-Identifier: Apache-2.0
#include "supervisor/spec/fingerprint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "config/settings/settings.hpp"
#include "ipc/base/input_file.hpp"
#include "ipc/base/join.hpp"
#include "supervisor/spec/service_spec.hpp"

namespace handcast::supervisor {
namespace {

/// Sections (with those inside them) and single settings.
using Paths = std::vector<std::string>;

/// Files that may change under their names: their content counts, too, of a large one its size and
/// time, because the supervisor must not read a film.
const Paths kFiles{"calibration", "projector2.calibration", "hand.left",
                   "hand.right",  "content.left",           "content.right"};

/// What only the supervisor reads.
bool is_the_supervisors(std::string_view service, std::string_view path) {
  return path == "name" || path == fmt::format("{}.process.standby", service) ||
         path == fmt::format("{}.enabled", service);
}

bool is_within(std::string_view path, std::string_view section) {
  return path == section ||
         (path.starts_with(section) && path.substr(section.size()).starts_with('.'));
}

bool is_in(std::string_view path, const Paths& paths) {
  return std::ranges::any_of(paths, [&](const auto& section) { return is_within(path, section); });
}

/// What the service reads with these back ends. Empty if the catalogue does not know one of them.
std::optional<Paths> reads_of(std::string_view service, const std::vector<std::string>& names,
                              const Catalogue& catalogue) {
  const auto found = catalogue.find(service);
  if (found == catalogue.end()) return std::nullopt;
  auto paths = found->second.settings;
  const auto& backends = found->second.backends;
  if (backends.empty()) return paths;
  for (const auto& name : names) {
    const auto row = std::ranges::find(backends, name, &daemon::BackendDescription::name);
    if (row == backends.end()) return std::nullopt;
    paths.insert(paths.end(), row->settings.begin(), row->settings.end());
  }
  return paths;
}

/// FNV-1a over a sequence of texts, each with its end.
class Hash {
 public:
  void add(std::string_view text) {
    for (const char c : text) add(c);
    add('\0');
  }
  std::string print() const { return fmt::format("{:016x}", value_); }

 private:
  void add(char c) { value_ = (value_ ^ static_cast<unsigned char>(c)) * 1099511628211ull; }
  std::uint64_t value_ = 14695981039346656037ull;
};

std::string content_of(const config::Setting& setting) {
  const auto& file = *std::get<std::string*>(setting.target);
  constexpr std::uintmax_t kLarge = 1 << 20;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return {};
  const auto bytes = std::filesystem::file_size(file, error);
  if (bytes <= kLarge) return read_input(file, kLarge).value_or("");
  const auto time = std::filesystem::last_write_time(file, error).time_since_epoch().count();
  return fmt::format("{} {}", bytes, time);
}

/// The word of SERVICE.NAME; null if there is no such setting.
std::string* word_of(std::string_view service, std::string_view name,
                     const config::Listing& listing) {
  const auto* word = config::find_setting(listing, fmt::format("{}.{}", service, name));
  return word ? std::get<std::string*>(word->target) : nullptr;
}

/// Null for a service without back ends.
std::string* backend_in(std::string_view service, const config::Listing& listing) {
  return word_of(service, "backend", listing);
}

/// The back end and, if the service has them, a second one beside it and its fallback.
std::vector<std::string> backends_in(std::string_view service, const config::Listing& listing) {
  std::vector<std::string> names;
  for (const auto* name : {"backend", "second", "fallback"})
    if (const auto* word = word_of(service, name, listing); word && !word->empty())
      names.push_back(*word);
  return names;
}

/// Whom a rig has, and what they read.
class Readers {
 public:
  Readers(const config::Rig& rig, const config::Listing& listing, const Catalogue& catalogue)
      : rig_(rig), catalogue_(catalogue) {
    for (const auto& [service, description] : catalogue)
      chosen_[service] = backends_in(service, listing);
    for (const auto& service : services_of(rig, catalogue)) active_.insert(service.name);
  }

  /// Why nobody reads a setting; "" if somebody does.
  std::string why_idle(std::string_view path) const {
    for (const auto& [service, description] : catalogue_) {
      if (!path.starts_with(service + ".")) continue;
      if (path == service + ".backend" || path == service + ".enabled") return {};
      if (!active_.contains(service)) return why_absent(service);
      if (is_read_by_another(path, service)) return {};
      if (is_within(path, "pose.handover") && rig_.pose.second.empty())
        return "pose.second is empty";
      if (is_of_another_backend(path, description))
        return fmt::format("{}.backend is \"{}\"", service, backend_of(service, rig_));
    }
    return {};
  }

  /// The service that a setting belongs to.
  std::string service_of(std::string_view path) const {
    return std::string(path.substr(0, path.find('.')));
  }

 private:
  bool is_chosen(const std::string& service, const std::string& backend) const {
    const auto& names = chosen_.at(service);
    return std::ranges::find(names, backend) != names.end();
  }

  std::string why_absent(const std::string& service) const {
    if (service == "observer" || service == "watch") return service + ".enabled is false";
    if (service == "landmarks2") return "the rig has no second camera";
    if (service == "bridge") return "the bridge neither sends nor receives anything";
    return fmt::format("{}.backend is \"none\"", service);
  }

  /// Whether it is what one back end of the service reads, and not one that is chosen.
  bool is_of_another_backend(std::string_view path,
                             const daemon::ServiceDescription& description) const {
    bool is_anothers = false;
    for (const auto& backend : description.backends) {
      const auto own_section = fmt::format("{}.{}", description.name, backend.name);
      const bool reads = is_within(path, own_section) || is_in(path, backend.settings);
      if (reads && is_chosen(description.name, backend.name)) return false;
      is_anothers = is_anothers || reads;
    }
    return is_anothers;
  }

  bool is_read_by_another(std::string_view path, const std::string& than) const {
    return std::ranges::any_of(active_, [&](const std::string& service) {
      const auto found = catalogue_.find(service);
      if (service == than || found == catalogue_.end()) return false;
      return is_in(path, found->second.settings) ||
             std::ranges::any_of(found->second.backends, [&](const auto& backend) {
               return is_chosen(service, backend.name) && is_in(path, backend.settings);
             });
    });
  }

  const config::Rig& rig_;
  const Catalogue& catalogue_;
  std::map<std::string, Paths> chosen_;  ///< by service
  std::set<std::string> active_;         ///< services of the rig
};

}  // namespace

std::string fingerprint_of(std::string_view service, const config::Rig& rig,
                           const Catalogue& catalogue) {
  auto copy = rig;  // a listing refers to values that can be written
  const auto listing = config::list_settings(copy);
  const auto reads = reads_of(service, backends_in(service, listing), catalogue);
  Hash hash;
  for (const auto& section : listing) {
    for (const auto& setting : section.settings) {
      if (is_the_supervisors(service, setting.path)) continue;
      if (reads ? !is_in(setting.path, *reads) : is_within(setting.path, "supervisor")) continue;
      hash.add(setting.path);
      hash.add(config::print_value(setting));
      if (is_in(setting.path, kFiles)) hash.add(content_of(setting));
    }
  }
  return hash.print();
}

std::string backend_of(std::string_view service, const config::Rig& rig) {
  auto copy = rig;
  const auto* backend = backend_in(service, config::list_settings(copy));
  return backend ? *backend : std::string();
}

config::Rig with_backend(config::Rig rig, std::string_view service, const std::string& backend) {
  if (auto* asked = backend_in(service, config::list_settings(rig))) *asked = backend;
  return rig;
}

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
  sentences.reserve(idle.size());
  for (const auto& [why, paths] : idle)
    sentences.push_back(fmt::format("{} {} no effect, because {}", join(paths, ", "),
                                    paths.size() == 1 ? "has" : "have", why));
  return sentences;
}

}  // namespace handcast::supervisor
