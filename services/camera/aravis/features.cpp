// SPDX-License-Identifier: Apache-2.0
#include "services/camera/aravis/features.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <vector>

#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"

namespace handcast::camera::aravis {
namespace {

template <class Number>
std::optional<Number> number_in(const std::string& text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

tl::unexpected<Error> refused(const std::string& name, const std::string& text,
                              const std::string& allowed) {
  return fail(Errc::bad_config, fmt::format("{}: {} is not {}", name, text, allowed));
}

Result<void> set_integer(ArvCamera* camera, const std::string& name, const std::string& text) {
  gint64 least = 0, most = 0;
  auto bounds = ask([&](GError** error) {
    arv_camera_get_integer_bounds(camera, name.c_str(), &least, &most, error);
  });
  if (!bounds) return bounds;
  const auto number = number_in<std::int64_t>(text);
  if (!number || *number < least || *number > most)
    return refused(name, text, fmt::format("a whole number in {}..{}", least, most));
  return ask([&](GError** error) { arv_camera_set_integer(camera, name.c_str(), *number, error); });
}

Result<void> set_float(ArvCamera* camera, const std::string& name, const std::string& text) {
  double least = 0, most = 0;
  auto bounds = ask([&](GError** error) {
    arv_camera_get_float_bounds(camera, name.c_str(), &least, &most, error);
  });
  if (!bounds) return bounds;
  const auto number = number_in<double>(text);
  if (!number || !(*number >= least && *number <= most))
    return refused(name, text, fmt::format("a number in {}..{}", least, most));
  return ask([&](GError** error) { arv_camera_set_float(camera, name.c_str(), *number, error); });
}

Result<void> set_boolean(ArvCamera* camera, const std::string& name, const std::string& text) {
  if (text != "true" && text != "false") return refused(name, text, "true or false");
  return ask(
      [&](GError** error) { arv_camera_set_boolean(camera, name.c_str(), text == "true", error); });
}

Result<void> set_words(ArvCamera* camera, const std::string& name, const std::string& text) {
  auto set = ask(
      [&](GError** error) { arv_camera_set_string(camera, name.c_str(), text.c_str(), error); });
  const auto words = words_of_feature(camera, name.c_str());
  if (!set && !words.empty()) return refused(name, text, "one of " + words);
  return set;
}

Result<void> set_by_kind(ArvCamera* camera, ArvGcNode* node, const std::string& name,
                         const std::string& text) {
  // An enumeration is also an integer.
  if (ARV_IS_GC_ENUMERATION(node)) return set_words(camera, name, text);
  if (ARV_IS_GC_BOOLEAN(node)) return set_boolean(camera, name, text);
  if (ARV_IS_GC_COMMAND(node))
    return ask([&](GError** error) { arv_camera_execute_command(camera, name.c_str(), error); });
  if (ARV_IS_GC_INTEGER(node)) return set_integer(camera, name, text);
  if (ARV_IS_GC_FLOAT(node)) return set_float(camera, name, text);
  return set_words(camera, name, text);
}

}  // namespace

Result<void> set_feature(ArvCamera* camera, const std::string& assignment) {
  const auto equals = assignment.find('=');
  const auto name = assignment.substr(0, equals);
  const auto text = equals == assignment.npos ? "" : assignment.substr(equals + 1);
  auto* node = arv_device_get_feature(arv_camera_get_device(camera), name.c_str());
  if (!node) return fail(Errc::bad_config, "the camera has no feature " + quote(name));
  if (equals == assignment.npos && !ARV_IS_GC_COMMAND(node))
    return fail(Errc::bad_config, fmt::format("{}: write {}=VALUE", name, name));
  auto set = set_by_kind(camera, node, name, text);
  if (!set && set.error().code == Errc::bad_config && !set.error().what.starts_with(name))
    return fail_in(name, set.error());
  return set;
}

std::string words_of_feature(ArvCamera* camera, const char* name) {
  guint count = 0;
  const auto words = ask([&](GError** error) {
    return arv_camera_dup_available_enumerations_as_strings(camera, name, &count, error);
  });
  if (!words || !*words) return {};
  const std::unique_ptr<const char*, Free> owned(*words);
  std::vector<std::string> texts(*words, *words + count);
  return join(texts, ", ");
}

}  // namespace handcast::camera::aravis
