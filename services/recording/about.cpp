// SPDX-License-Identifier: Apache-2.0
#include "services/recording/about.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "ipc/base/input_file.hpp"
#include "services/recording/index_row.hpp"
#include "services/recording/streams.hpp"

namespace handcast::recording {
namespace {

using nlohmann::ordered_json;

constexpr std::string_view kFormat = "handcast recording";
constexpr int kVersion = 1;

/// The text at a key; empty if there is none.
std::string text_at(const nlohmann::json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

Result<About> about_of(const nlohmann::json& object) {
  if (!object.is_object() || text_at(object, "format") != kFormat)
    return fail(Errc::bad_data, "it does not describe a recording of handcast");
  const auto version = object.find("version");
  if (version == object.end() || !version->is_number_integer() || *version != kVersion)
    return fail(Errc::bad_config,
                fmt::format("the recording is of another version of handcast than this one, which "
                            "reads version {} of the format",
                            kVersion));
  About about{text_at(object, "rig"), {}};
  if (const auto streams = object.find("streams"); streams != object.end() && streams->is_object())
    for (const auto& [name, stream] : streams->items())
      if (stream.is_object()) about.layouts[name] = text_at(stream, "layout");
  return about;
}

}  // namespace

std::string about_text(const std::string& rig, const std::vector<std::string>& streams) {
  ordered_json index = ordered_json::array();
  for (const auto& field : kIndexFields) index.push_back({field.name, field.type});
  ordered_json all = ordered_json::object();
  for (const auto& name : streams) {
    const auto& type = *type_of_stream(name);
    all[name] = {{"layout", type.layout},
                 {"channels", type.channels},
                 {"message", ordered_json::parse(type.fields)}};
  }
  const ordered_json about{
      {"format", kFormat}, {"version", kVersion}, {"rig", rig}, {"index", index}, {"streams", all}};
  return about.dump() + "\n";
}

Result<About> read_about(const std::filesystem::path& folder) {
  const auto file = folder / kAboutFile;
  const auto text = read_input(file, kMostText);
  if (!text) return tl::make_unexpected(text.error());
  auto about = about_of(nlohmann::json::parse(*text, nullptr, false));
  if (!about) return fail_in(file.string(), about.error());
  return about;
}

bool is_recording(const std::filesystem::path& folder) {
  std::error_code failed;
  return std::filesystem::exists(folder / kAboutFile, failed);
}

std::string stream_of(const std::filesystem::path& folder, std::string wanted,
                      std::string otherwise) {
  const auto about = read_about(folder);
  return about && !about->layouts.contains(wanted) ? otherwise : wanted;
}

Result<void> check_folder(const std::filesystem::path& folder) {
  std::error_code failed;
  if (std::filesystem::is_directory(folder, failed)) return {};
  return fail(
      Errc::bad_config,
      fmt::format("'{}' is not a folder; `handcast record` makes recordings", folder.string()));
}

}  // namespace handcast::recording
