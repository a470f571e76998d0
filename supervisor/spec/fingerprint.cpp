// SPDX-License-Identifier: Apache-2.0
#include "supervisor/spec/fingerprint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "config/settings/settings.hpp"
#include "ipc/base/input_file.hpp"

namespace handcast::supervisor {
namespace {

/// Sections (with those inside them) and single settings.
using Paths = std::vector<std::string>;

/// Files that may change under their names: their content counts, too.
const Paths kFiles{"calibration", "hand.left", "hand.right", "content.left", "content.right"};

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
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return {};
  return read_input(file, kMostMesh).value_or("");
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

}  // namespace handcast::supervisor
