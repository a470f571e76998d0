// SPDX-License-Identifier: Apache-2.0
#include "services/tools/init/candidate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <tuple>

#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"

namespace handcast::init {
namespace {

using devices::Attached;
using devices::Kind;

constexpr std::size_t kShortestPart = 3;  ///< of a text, to mean a candidate

bool is_plain(char c) { return c >= ' ' && c <= '~'; }

const std::string& backend_of(const Attached& device) { return device.settings.front().second; }

/// The first of the device's names that is text and that no other device of its driver has; empty
/// if it has none.
std::string unique_name(const Attached& device, const std::vector<Attached>& attached) {
  const auto is_of_another = [&](const std::string& name) {
    return std::ranges::any_of(attached, [&](const Attached& other) {
      return &other != &device && std::ranges::count(other.names, name) > 0 &&
             backend_of(other) == backend_of(device);
    });
  };
  for (const auto& name : device.names)
    if (std::ranges::all_of(name, is_plain) && !is_of_another(name)) return name;
  return {};
}

std::string text_of(const Attached& device) {
  auto text = device.name;
  if (!device.about.empty()) text += ", " + device.about;
  if (!device.trouble.empty()) text += "; cannot be used now: " + device.trouble;
  return one_line(text);
}

std::vector<Candidate> devices_among(const std::vector<Attached>& attached, Kind kind) {
  std::vector<Candidate> candidates;
  for (const auto& device : attached) {
    if (device.kind != kind) continue;
    const auto name = unique_name(device, attached);
    if (name.empty()) continue;
    candidates.push_back({.word = backend_of(device) + ':' + name,
                          .text = text_of(device),
                          .backend = backend_of(device),
                          .name = name,
                          .device = device});
  }
  return candidates;
}

bool can_be_used(const Candidate& candidate) {
  return candidate.is_device() && candidate.device.trouble.empty();
}

/// Webcams that see infrared light send grey images.
bool sees_infrared(const Candidate& camera) {
  const auto& modes = camera.device.modes;
  return camera.backend == "aravis" ||
         (!modes.empty() && (modes[0].format == "GREY" || modes[0].format.starts_with("Y1")));
}

using Test = std::function<bool(const Candidate&)>;

std::vector<std::size_t> those(std::span<const Candidate> candidates, const Test& test) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (test(candidates[i])) found.push_back(i);
  return found;
}

/// The first candidate that passes one of the tests, of which the first one counts most; the last
/// candidate if none does.
std::size_t best(std::span<const Candidate> candidates, std::initializer_list<Test> tests) {
  for (const auto& test : tests)
    if (const auto found = those(candidates, test); !found.empty()) return found.front();
  return candidates.size() - 1;
}

std::string lower(std::string_view text) {
  std::string lowered(text);
  for (char& c : lowered)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lowered;
}

std::string words_of(std::span<const Candidate> candidates,
                     const std::vector<std::size_t>& chosen) {
  std::vector<std::string> words;
  words.reserve(chosen.size());
  for (const auto i : chosen) words.push_back(fmt::format("'{}'", candidates[i].word));
  return join(words, ", ");
}

}  // namespace

std::string one_line(std::string_view text) {
  std::string line(text);
  std::ranges::replace_if(line, std::not_fn(is_plain), '?');
  return line;
}

std::vector<Candidate> cameras_among(const std::vector<Attached>& attached) {
  auto cameras = devices_among(attached, Kind::camera);
  cameras.push_back({.word = "twin", .text = "none: the digital twin", .backend = "twin"});
  return cameras;
}

std::vector<Candidate> lights_among(const std::vector<Attached>& attached) {
  auto lights = devices_among(attached, Kind::display);
  lights.push_back({.word = "file", .text = "none: pictures in a folder", .backend = "file"});
  lights.push_back({.word = "twin", .text = "none: the digital twin", .backend = "twin"});
  return lights;
}

std::vector<Candidate> controllers_among(const std::vector<Attached>& attached) {
  return devices_among(attached, Kind::controller);
}

std::size_t likely_camera(std::span<const Candidate> cameras) {
  return best(cameras,
              {[](const Candidate& camera) { return can_be_used(camera) && sees_infrared(camera); },
               can_be_used});
}

std::size_t likely_light(std::span<const Candidate> lights) {
  return best(lights, {[](const Candidate& light) {
                return can_be_used(light) && !light.device.is_operators;
              }});
}

Result<std::size_t> find(std::span<const Candidate> candidates, std::string_view answer) {
  const std::initializer_list<Test> tests{
      [&](const Candidate& one) { return one.word == answer; },
      [&](const Candidate& one) {
        return std::ranges::find(one.device.names, answer) != one.device.names.end();
      },
      [&](const Candidate& one) { return one.backend == answer; },
      [&](const Candidate& one) {
        return answer.size() >= kShortestPart &&
               lower(one.text).find(lower(answer)) != std::string::npos;
      }};
  for (const auto& test : tests) {
    const auto found = those(candidates, test);
    if (found.size() == 1) return found.front();
    if (!found.empty())
      return fail(Errc::bad_config,
                  fmt::format("{} can be {}", quote(answer), words_of(candidates, found)));
  }
  const auto all = those(candidates, [](const Candidate&) { return true; });
  return fail(Errc::unavailable,
              fmt::format("there is no {}; there is {}", quote(answer), words_of(candidates, all)));
}

std::optional<Candidate> not_attached(std::string_view answer,
                                      std::span<const std::string_view> backends) {
  const auto colon = answer.find(':');
  const std::string backend(answer.substr(0, colon));
  if (colon == answer.npos || std::ranges::find(backends, backend) == backends.end())
    return std::nullopt;
  const std::string name(answer.substr(colon + 1));
  if (name.empty() || !std::ranges::all_of(name, is_plain)) return std::nullopt;
  const auto text = name + ", which is not attached now";
  Candidate later{
      .word = std::string(answer), .text = text, .backend = backend, .name = name, .device = {}};
  later.device.name = text;
  later.device.names = {name};
  return later;
}

namespace {

using devices::Mode;

constexpr Size kReference{720, 540};
constexpr Size kEnough{640, 480};

bool contains(const Mode& mode, Size size) {
  return size.width_px >= mode.least_width_px && size.width_px <= mode.width_px &&
         size.height_px >= mode.least_height_px && size.height_px <= mode.height_px;
}

/// The size in the mode that is nearest to the reference rig's.
Images nearest(const Mode& mode) {
  return {mode.format,
          {std::clamp(kReference.width_px, mode.least_width_px, mode.width_px),
           std::clamp(kReference.height_px, mode.least_height_px, mode.height_px)},
          mode.rate_hz};
}

/// Less is better.
auto order_of(const Images& images) {
  const bool is_small =
      images.size.width_px < kEnough.width_px || images.size.height_px < kEnough.height_px;
  const long pixels = static_cast<long>(images.size.width_px) * images.size.height_px;
  const long off =
      std::labs(pixels - static_cast<long>(kReference.width_px) * kReference.height_px);
  return std::tuple(is_small, is_small ? off : 0, -images.rate_hz, off);
}

}  // namespace

std::optional<Images> fastest(const std::vector<Mode>& modes, Size size) {
  std::optional<Images> best;
  for (const auto& mode : modes)
    if (contains(mode, size) && (!best || mode.rate_hz > best->rate_hz))
      best = {mode.format, size, mode.rate_hz};
  return best;
}

Images recommended(const std::vector<Mode>& modes) {
  Images best = nearest(modes.front());
  for (const auto& mode : modes)
    if (const auto images = nearest(mode); order_of(images) < order_of(best)) best = images;
  return best;
}

}  // namespace handcast::init
