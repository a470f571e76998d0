// SPDX-License-Identifier: Apache-2.0
#include "config/content_chain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>

#include "ipc/base/home.hpp"
#include "ipc/base/quote.hpp"

namespace handcast::config {
namespace {

constexpr std::string_view kBetween = " | ";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(' ');
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// "name=value" at the end of a text, taken off it; empty if there is none.
std::optional<std::pair<std::string, std::string>> last_parameter(std::string_view& text) {
  std::size_t begin = text.npos, end = text.size();
  std::string_view value;
  if (text.ends_with('"') && text.size() > 1) {
    const auto quote = text.rfind("=\"", text.size() - 2);
    if (quote == text.npos) return std::nullopt;
    value = text.substr(quote + 2, text.size() - quote - 3);
    end = quote;
  } else {
    const auto equals = text.rfind('=');
    if (equals == text.npos || text.find(' ', equals) != text.npos) return std::nullopt;
    value = text.substr(equals + 1);
    end = equals;
  }
  begin = text.rfind(' ', end);
  if (begin == text.npos) return std::nullopt;
  const auto name = text.substr(begin + 1, end - begin - 1);
  const bool is_name =
      !name.empty() && !std::isdigit(static_cast<unsigned char>(name[0])) &&
      std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) || c == '_'; });
  if (!is_name) return std::nullopt;
  text = trimmed(text.substr(0, begin));
  return std::pair{std::string(name), std::string(value)};
}

bool is_kind(std::string_view word) {
  return word.size() > 1 && std::ranges::all_of(word, [](unsigned char c) {
           return std::islower(c) || std::isdigit(c);
         });
}

Result<ContentElement> parse_element(std::string_view text) {
  ContentElement element;
  std::string_view rest = trimmed(text);
  if (std::ranges::count(rest, '"') % 2 != 0)
    return fail(Errc::bad_config, fmt::format("{} has a quote that is not closed", quote(rest)));
  while (auto parameter = last_parameter(rest))
    element.parameters.insert(element.parameters.begin(), std::move(*parameter));
  const auto colon = rest.find(':');
  const bool is_address = rest.find("://") == colon && colon != rest.npos;
  if (colon != rest.npos && !is_address && is_kind(rest.substr(0, colon))) {
    element.kind = rest.substr(0, colon);
    rest = trimmed(rest.substr(colon + 1));
  } else {
    element.kind = content_kind_of(rest);
    if (element.kind.empty()) element.kind = "look";
  }
  if (element.kind == "builtin") element.kind = "pattern";
  element.what = rest;
  if (element.what.empty() && element.kind == "look")
    return fail(Errc::bad_config,
                "content is empty; name a look, a file or a source, e.g. \"builtin:atlas\"");
  return element;
}

std::string print_element(const ContentElement& element) {
  std::string text = element.what;
  const auto named = parse_element(element.what);
  const bool says_it = named && named->kind == element.kind && named->what == element.what &&
                       named->parameters.empty();
  const std::string_view kind = element.kind == "pattern" ? "builtin" : element.kind;
  if (!says_it) text = fmt::format("{}:{}", kind, element.what);
  for (const auto& [name, value] : element.parameters) {
    const bool is_quoted = value.empty() || value.find(' ') != value.npos;
    text += is_quoted ? fmt::format(" {}=\"{}\"", name, value) : fmt::format(" {}={}", name, value);
  }
  return text;
}

}  // namespace

Result<ContentChain> parse_content(std::string_view text) {
  ContentChain chain;
  for (std::size_t begin = 0; begin <= text.size();) {
    const auto end = std::min(text.find(kBetween, begin), text.size());
    auto element = parse_element(text.substr(begin, end - begin));
    if (!element) return tl::make_unexpected(element.error());
    chain.push_back(std::move(*element));
    begin = end + kBetween.size();
    if (end == text.size()) break;
  }
  return chain;
}

std::string print_content(const ContentChain& chain) {
  std::string text;
  for (const auto& element : chain)
    text += (text.empty() ? "" : std::string(kBetween)) + print_element(element);
  return text;
}

Result<std::string> resolve_content(std::string_view text, const std::filesystem::path& folder) {
  auto chain = parse_content(text);
  if (!chain) return tl::make_unexpected(chain.error());
  for (auto& element : *chain) {
    if (!is_content_file(element)) continue;
    const auto whole = expand_home(element.what);
    if (!whole) return tl::make_unexpected(whole.error());
    if (auto fault = fault_of_path(*whole, folder); !fault.empty())
      return fail(Errc::bad_config, std::move(fault));
    element.what = (folder / *whole).lexically_normal().string();
  }
  return print_content(*chain);
}

std::string_view content_kind_of(std::string_view file) {
  if (file.starts_with("/dev/video")) return "capture";
  if (file.starts_with("file:")) return "picture";
  if (file.find("://") != file.npos) return "film";
  const bool is_path = file.find('/') != file.npos;
  const auto dot = file.rfind('.');
  if (dot == file.npos || dot < file.rfind('/') + 1) return is_path ? "picture" : "";
  std::string end(file.substr(dot + 1));
  std::ranges::transform(end, end.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto is_one_of = [&](auto... words) { return ((end == words) || ...); };
  if (is_one_of("png", "jpg", "jpeg")) return "picture";
  if (is_one_of("fs", "isf")) return "isf";
  if (is_one_of("glsl", "frag", "shadertoy")) return "shadertoy";
  if (is_one_of("mp4", "m4v", "mov", "avi", "mkv", "webm", "mpg", "mpeg", "gif", "ts"))
    return "film";
  return is_path ? "picture" : "";
}

bool is_content_file(const ContentElement& element) {
  const auto& kind = element.kind;
  const bool has_file = kind == "picture" || kind == "film" || kind == "isf" || kind == "shadertoy";
  const bool is_address = kind == "film" && element.what.find("://") != std::string::npos;
  return has_file && !element.what.empty() && !is_address;
}

bool is_still(const ContentChain& chain) {
  return chain.size() == 1 && (chain[0].kind == "picture" || chain[0].kind == "pattern") &&
         chain[0].parameters.empty();
}

}  // namespace handcast::config
