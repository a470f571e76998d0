// SPDX-License-Identifier: Apache-2.0
#include "services/content/projegraphy/remote.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "ipc/base/clock.hpp"
#include "ipc/base/input_file.hpp"
#include "ipc/base/join.hpp"
#include "services/content/projegraphy/animals.hpp"
#include "services/content/projegraphy/exchange.hpp"
#include "services/content/projegraphy/painter.hpp"

namespace handcast::projegraphy {
namespace {

using nlohmann::json;

constexpr std::int64_t kHour_ns = 3'600'000'000'000, kRest_ns = 20'000'000'000;
constexpr std::size_t kMostAnswer = 64 << 10;
constexpr std::size_t kLongestName = 24;
constexpr std::string_view kNone = "none";
constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::string in_base64(std::string_view bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k < bytes.size() + 1 ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// The bytes of a text in base64, with or without "data:...;base64," before it. Empty if it is
/// none.
std::string from_base64(std::string_view text) {
  if (text.starts_with("data:")) text.remove_prefix(std::min(text.size(), text.find(',') + 1));
  std::string bytes;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    const auto digit = kDigits.find(c);
    if (digit == kDigits.npos) return {};
    group = group << 6 | static_cast<std::uint32_t>(digit);
    if ((bits += 6) < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(group >> bits & 0xff);
  }
  return bytes;
}

json question_of(const Servers& servers, const std::string& png) {
  std::vector<std::string_view> names;
  for (const auto& animal : animals()) names.push_back(animal.name);
  const auto text = fmt::format(
      "The picture is the shadow of one or two hands. Which of these animals does it resemble "
      "most: {}? Answer with JSON alone: {{\"animal\": \"NAME\"}}, with the name {} if it "
      "resembles "
      "none of them.",
      join(names, ", "), kNone);
  const json words{{"type", "text"}, {"text", text}};
  const json picture{{"type", "image_url"},
                     {"image_url", {{"url", "data:image/png;base64," + in_base64(png)}}}};
  const json message{{"role", "user"}, {"content", json::array({words, picture})}};
  return {{"model", servers.model},
          {"max_tokens", 30},
          {"temperature", 0},
          {"response_format", {{"type", "json_object"}}},
          {"messages", json::array({message})}};
}

/// The animal in a reply, -1 for none of them; empty if it is not as asked for, or not one of ours.
std::optional<int> animal_in(const std::string& reply) {
  const auto whole = json::parse(reply, nullptr, false);
  const json::json_pointer at("/choices/0/message/content");
  if (!whole.is_object() || !whole.contains(at) || !whole.at(at).is_string()) return {};
  const auto answer = json::parse(whole.at(at).get<std::string>(), nullptr, false);
  if (!answer.is_object() || !answer.contains("animal") || !answer["animal"].is_string()) return {};
  auto name = answer["animal"].get<std::string>();
  if (name.size() > kLongestName) return {};
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const int animal = projegraphy::animal_of(name);
  return animal >= 0 || name == kNone ? std::optional(animal) : std::nullopt;
}

json commission_of(const Servers& servers, std::string_view animal, const std::string& png) {
  const json unit{
      {"enabled", true},      {"module", "canny"},       {"model", "control_v11p_sd15_canny"},
      {"weight", 1.0},        {"image", in_base64(png)}, {"resize_mode", 1},
      {"pixel_perfect", true}};
  return {{"prompt", prompt_of(servers, animal)},
          {"negative_prompt", kUnwanted},
          {"width", kPictureSide_px},
          {"height", kPictureSide_px},
          {"steps", 20},
          {"alwayson_scripts", {{"controlnet", {{"args", json::array({unit})}}}}}};
}

}  // namespace

Result<std::string> Remote::ask(const Servers& servers, const Request& request,
                                const std::stop_token& stop) {
  std::chrono::milliseconds pause(400);
  const auto silent = silent_ns_.find(request.url);
  if (silent != silent_ns_.end() && now_ns() - silent->second < kRest_ns)
    return fail(Errc::unavailable, fmt::format("{} is not asked for 20 s, as it does not answer",
                                               host_of(request.url)));
  for (int tried = 1;; ++tried, pause *= 2) {
    const auto now = now_ns();
    while (!asked_ns_.empty() && now - asked_ns_.front() > kHour_ns) asked_ns_.pop_front();
    if (std::ssize(asked_ns_) >= servers.per_hour)
      return fail(Errc::unavailable,
                  fmt::format("the {} requests of this hour are spent", servers.per_hour));
    asked_ns_.push_back(now);
    auto reply = fetch(request, stop);
    const bool may_go_away =
        !reply && (reply.error().code == Errc::unavailable || reply.error().code == Errc::timeout);
    if (may_go_away) silent_ns_[request.url] = now_ns();
    if (!may_go_away) silent_ns_.erase(request.url);
    if (!may_go_away || tried >= servers.tries || stop.stop_requested()) return reply;
    rest(pause, stop);
  }
}

Result<int> Remote::animal_of(const Servers& servers, const Silhouette& silhouette,
                              const std::stop_token& stop) {
  const auto png = mask_png(silhouette);
  if (!png) return tl::make_unexpected(png.error());
  const Request request{
      .url = without_slash(servers.recogniser) + "/v1/chat/completions",
      .body = text_of(question_of(servers, *png)),
      .key = servers.key,
      .patience = std::chrono::milliseconds(static_cast<std::int64_t>(1000 * servers.patience_s)),
      .most_bytes = kMostAnswer};
  const auto reply = ask(servers, request, stop);
  if (!reply) return tl::make_unexpected(reply.error());
  const auto animal = animal_in(*reply);
  if (!animal)
    return fail(Errc::bad_data, fmt::format("{} does not answer with one of the animals",
                                            host_of(servers.recogniser)));
  return *animal;
}

Result<renderer::Texture> Remote::picture_of(const Servers& servers, const Silhouette& silhouette,
                                             std::string_view animal, const std::stop_token& stop) {
  if (!servers.workflow.empty()) return by_workflow(servers, silhouette, animal, stop);
  const auto png = mask_png(silhouette);
  if (!png) return tl::make_unexpected(png.error());
  const Request request{
      .url = without_slash(servers.painter) + "/sdapi/v1/txt2img",
      .body = text_of(commission_of(servers, animal, *png)),
      .patience = std::chrono::milliseconds(static_cast<std::int64_t>(1000 * servers.patience_s)),
      .most_bytes = kMostPainting};
  const auto reply = ask(servers, request, stop);
  if (!reply) return tl::make_unexpected(reply.error());
  const auto whole = json::parse(*reply, nullptr, false);
  const json::json_pointer at("/images/0");
  const bool has_picture = whole.is_object() && whole.contains(at) && whole.at(at).is_string();
  const auto picture = has_picture
                           ? picture_in(from_base64(whole.at(at).get_ref<const std::string&>()))
                           : Result<renderer::Texture>(fail(Errc::bad_data, ""));
  if (!picture)
    return fail(Errc::bad_data, fmt::format("{} does not answer with a picture that can be read",
                                            host_of(servers.painter)));
  return *picture;
}

std::string ServerKey::for_server(const std::string& address) const {
  return !server.empty() && without_slash(address) == without_slash(server) ? key : "";
}

Result<ServerKey> read_key(const std::string& file) {
  std::string text;
  if (file.empty()) {
    const char* set = std::getenv("HANDCAST_PROJEGRAPHY_KEY");
    if (!set) return ServerKey();
    text = set;
  } else {
    constexpr std::uint64_t kMostKey = 4096;
    auto read = read_input(file, kMostKey);
    if (!read) return tl::make_unexpected(read.error());
    text = std::move(*read);
  }
  std::istringstream words(text);
  ServerKey key;
  std::string more;
  const bool has_two = static_cast<bool>(words >> key.server >> key.key) && !(words >> more);
  const bool is_plain =
      std::ranges::all_of(key.key, [](unsigned char c) { return c > 32 && c < 127; });
  if (!has_two || !is_plain || host_of(key.server).empty())
    return fail(Errc::bad_config,
                "the key of the recogniser cannot be used: write the address of its server and the "
                "key, with a space between them, in one line");
  return key;
}

}  // namespace handcast::projegraphy
