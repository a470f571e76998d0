// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "ipc/base/clock.hpp"
#include "ipc/base/input_file.hpp"
#include "ipc/base/quote.hpp"
#include "services/content/projegraphy/exchange.hpp"

namespace handcast::projegraphy {
namespace {

using nlohmann::json;

constexpr std::size_t kLongestText = 200;
constexpr std::chrono::milliseconds kPoll(250);
/// What is replaced in a workflow.
constexpr std::string_view kPromptPlace = "HANDCAST_PROMPT", kMaskPlace = "HANDCAST_MASK";

/// What its API calls a file.
struct StoredPicture {
  std::string name, folder, type;
};

Error not_understood(const Servers& servers, const char* what) {
  return {Errc::bad_data,
          fmt::format("{} does not answer with {}", host_of(servers.painter), what)};
}

/// The text of a key; "" if there is none, or a strange one.
std::string text_at(const json& object, const char* key) {
  if (!object.is_object() || !object.contains(key) || !object[key].is_string()) return "";
  auto text = object[key].get<std::string>();
  return text.size() <= kLongestText ? text : "";
}

/// A form with one file, as browsers upload it.
std::string form_of(const std::string& png, std::string_view border) {
  return fmt::format(
      "--{0}\r\nContent-Disposition: form-data; name=\"image\"; filename=\"handcast.png\"\r\n"
      "Content-Type: image/png\r\n\r\n{1}\r\n--{0}\r\nContent-Disposition: form-data; "
      "name=\"overwrite\"\r\n\r\ntrue\r\n--{0}--\r\n",
      border, png);
}

/// Puts a text into all texts of a workflow that have its place.
void put(json& value, std::string_view place, const std::string& text) {
  if (value.is_structured())
    for (auto& part : value) put(part, place, text);
  if (!value.is_string()) return;
  auto whole = value.get<std::string>();
  if (const auto at = whole.find(place); at != whole.npos) {
    whole.replace(at, place.size(), text);
    value = whole;
  }
}

/// For a part of an address.
std::string escaped(std::string_view text) {
  std::string out;
  for (const unsigned char c : text)
    out += std::isalnum(c) || c == '-' || c == '_' || c == '.'
               ? std::string(1, static_cast<char>(c))
               : fmt::format("%{:02X}", c);
  return out;
}

/// The first picture among the outputs of a job; empty if it has none.
StoredPicture picture_of_job(const json& job) {
  if (!job.is_object() || !job.contains("outputs") || !job["outputs"].is_object()) return {};
  for (const auto& output : job["outputs"]) {
    if (!output.is_object() || !output.contains("images") || !output["images"].is_array()) continue;
    for (const auto& image : output["images"])
      if (auto name = text_at(image, "filename"); !name.empty())
        return {std::move(name), text_at(image, "subfolder"), text_at(image, "type")};
  }
  return {};
}

std::int64_t ms_of(double seconds) { return static_cast<std::int64_t>(1e3 * seconds); }

bool is_id(std::string_view id) {
  return !id.empty() &&
         std::ranges::all_of(id, [](unsigned char c) { return std::isalnum(c) || c == '-'; });
}

/// Fetches a picture that the server has stored.
Result<renderer::Texture> fetch_stored(const Servers& servers, const StoredPicture& stored,
                                       const std::stop_token& stop) {
  const auto bytes = fetch({.url = fmt::format("{}/view?filename={}&subfolder={}&type={}",
                                               without_slash(servers.painter), escaped(stored.name),
                                               escaped(stored.folder), escaped(stored.type)),
                            .patience = std::chrono::milliseconds(ms_of(servers.patience_s)),
                            .most_bytes = kMostPainting},
                           stop);
  if (!bytes) return tl::make_unexpected(bytes.error());
  auto picture = picture_in(*bytes);
  if (!picture) return tl::make_unexpected(not_understood(servers, "a picture that can be read"));
  return picture;
}

/// Waits for the picture of a job, at most as long as the patience with a server.
Result<renderer::Texture> await_job(const Servers& servers, const std::string& id,
                                    const std::stop_token& stop) {
  const auto end_ns = now_ns() + seconds_to_ns(servers.patience_s);
  const auto url = without_slash(servers.painter) + "/history/" + id;
  for (; now_ns() < end_ns && !stop.stop_requested(); rest(kPoll, stop)) {
    const auto left = std::chrono::milliseconds(ms_of(ns_to_seconds(end_ns - now_ns())) + 1);
    const auto told = fetch({.url = url, .patience = left}, stop);
    if (!told) return tl::make_unexpected(told.error());
    const auto history = json::parse(*told, nullptr, false);
    if (!history.is_object()) return tl::make_unexpected(not_understood(servers, "a history"));
    if (!history.contains(id)) continue;
    const auto stored = picture_of_job(history[id]);
    if (!stored.name.empty()) return fetch_stored(servers, stored, stop);
    return fail(
        Errc::bad_data,
        fmt::format("the workflow has made no picture on {}; does it run in ComfyUI itself?",
                    host_of(servers.painter)));
  }
  return fail(Errc::timeout, fmt::format("{} does not paint within {:g} s",
                                         host_of(servers.painter), servers.patience_s));
}

}  // namespace

Result<std::string> read_workflow(const std::string& file) {
  constexpr std::uint64_t kMostWorkflow = 1 << 20;
  auto text = read_input(file, kMostWorkflow);
  if (!text) return tl::make_unexpected(text.error());
  const auto parsed = json::parse(*text, nullptr, false);
  // What the editor saves has a list of nodes; what its API takes has nodes by their numbers.
  const bool is_for_api =
      parsed.is_object() && !parsed.empty() && std::ranges::all_of(parsed, [](const auto& node) {
        return node.is_object() && node.contains("class_type");
      });
  if (is_for_api && text->find(kPromptPlace) != text->npos && text->find(kMaskPlace) != text->npos)
    return text;
  return fail(Errc::bad_config,
              fmt::format("{} is no workflow that can be used: export it for the API, with the "
                          "prompt {} and an image {}",
                          quote(file), kPromptPlace, kMaskPlace));
}

Result<renderer::Texture> Remote::by_workflow(const Servers& servers, const Silhouette& silhouette,
                                              std::string_view animal,
                                              const std::stop_token& stop) {
  const auto png = mask_png(silhouette);
  if (!png) return tl::make_unexpected(png.error());
  const auto server = without_slash(servers.painter);
  const auto patience = std::chrono::milliseconds(ms_of(servers.patience_s));
  constexpr std::string_view kBorder = "handcast-7f2b1c";
  const auto uploaded = ask(servers,
                            {.url = server + "/upload/image",
                             .body = form_of(*png, kBorder),
                             .type = fmt::format("multipart/form-data; boundary={}", kBorder),
                             .patience = patience},
                            stop);
  if (!uploaded) return tl::make_unexpected(uploaded.error());
  const auto mask = text_at(json::parse(*uploaded, nullptr, false), "name");
  if (mask.empty()) return tl::make_unexpected(not_understood(servers, "the name of the mask"));

  auto workflow = json::parse(servers.workflow, nullptr, false);
  put(workflow, kPromptPlace, prompt_of(servers, animal));
  put(workflow, kMaskPlace, mask);
  const auto queued = ask(
      servers,
      {.url = server + "/prompt", .body = text_of({{"prompt", workflow}}), .patience = patience},
      stop);
  if (!queued) return tl::make_unexpected(queued.error());
  const auto id = text_at(json::parse(*queued, nullptr, false), "prompt_id");
  if (!is_id(id)) return tl::make_unexpected(not_understood(servers, "the number of a job"));
  auto painted = await_job(servers, id, stop);
  // Its queue would only grow.
  if (!painted && painted.error().code == Errc::timeout)
    silent_ns_[server + "/upload/image"] = now_ns();
  return painted;
}

}  // namespace handcast::projegraphy
