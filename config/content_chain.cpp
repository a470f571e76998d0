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

/// A part of a text between spaces: NAME=VALUE, or something else.
struct Word {
  std::string_view written;
  std::string name, value;  ///< empty if it is no parameter
};

bool is_name(std::string_view text) {
  return !text.empty() && !std::isdigit(static_cast<unsigned char>(text[0])) &&
         std::ranges::all_of(text, [](unsigned char c) { return std::isalnum(c) || c == '_'; });
}

bool is_kind(std::string_view word) {
  return word.size() > 1 && std::ranges::all_of(word, [](unsigned char c) {
           return std::islower(c) || std::isdigit(c);
         });
}

/// Takes a quoted text with its quotes off the beginning of `rest`; \" and \\ stand for " and \.
/// Empty if the quote is not closed before a space or the end.
std::optional<std::string> take_quoted(std::string_view& rest) {
  std::string text;
  for (std::size_t i = 1; i < rest.size(); ++i) {
    const bool is_escape =
        rest[i] == '\\' && i + 1 < rest.size() && (rest[i + 1] == '"' || rest[i + 1] == '\\');
    if (is_escape) {
      text += rest[++i];
    } else if (rest[i] == '"') {
      rest.remove_prefix(i + 1);
      if (!rest.empty() && rest[0] != ' ') return std::nullopt;
      return text;
    } else {
      text += rest[i];
    }
  }
  return std::nullopt;
}

void skip_spaces(std::string_view& rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
}

tl::unexpected<Error> not_closed(std::string_view text) {
  return fail(
      Errc::bad_config,
      fmt::format("{} has a quote that is not closed, or that no space follows", quote(text)));
}

/// Takes the next word off a text that begins with one.
Result<Word> take_word(std::string_view& rest) {
  Word word;
  const std::string_view whole = rest;
  auto end = std::min(rest.find(' '), rest.size());
  const auto equals = rest.substr(0, end).find('=');
  if (equals != rest.npos && is_name(rest.substr(0, equals))) {
    word.name = rest.substr(0, equals);
    word.value = rest.substr(equals + 1, end - equals - 1);
    if (word.value.starts_with('"')) {
      std::string_view quoted = rest.substr(equals + 1);
      auto value = take_quoted(quoted);
      if (!value) return not_closed(whole);
      word.value = std::move(*value);
      end = rest.size() - quoted.size();
    }
  }
  word.written = rest.substr(0, end);
  rest.remove_prefix(end);
  return word;
}

bool is_file_kind(std::string_view kind) {
  return kind == "picture" || kind == "film" || kind == "isf" || kind == "shadertoy";
}

/// Takes "kind:" off the beginning of a text; "" if there is none.
std::string take_kind(std::string_view& rest) {
  const auto colon = rest.find(':');
  if (colon == rest.npos || rest.find("://") == colon || !is_kind(rest.substr(0, colon))) return {};
  std::string kind(rest.substr(0, colon));
  rest.remove_prefix(colon + 1);
  skip_spaces(rest);
  return kind;
}

/// Kinds that are written without a colon, as if they were looks.
bool needs_no_name(std::string_view kind) {
  return kind == "hand" || kind == "paint" || kind == "projegraphy" || kind == "skeleton";
}

Result<void> settle_kind(ContentElement& element) {
  auto& kind = element.kind;
  if (kind.empty() && needs_no_name(element.what)) std::swap(kind, element.what);
  if (kind.empty()) kind = content_kind_of(element.what);
  if (kind.empty()) kind = "look";
  if (kind == "builtin") kind = "pattern";
  if (!element.what.empty() || (kind != "look" && kind != "pattern" && kind != "capture" &&
                                kind != "view" && !is_file_kind(kind)))
    return {};
  return fail(Errc::bad_config,
              "content is empty; name a look, a file or a source, e.g. \"builtin:atlas\"");
}

/// Takes an element and the bar behind it off the beginning of a text.
Result<ContentElement> take_element(std::string_view& rest, bool& has_next) {
  ContentElement element;
  has_next = false;
  skip_spaces(rest);
  element.kind = take_kind(rest);
  const bool is_quoted = rest.starts_with('"');
  if (is_quoted) {
    const std::string_view whole = rest;
    auto what = take_quoted(rest);
    if (!what) return not_closed(whole);
    element.what = std::move(*what);
    skip_spaces(rest);
  }
  const char* const begin = rest.data();
  const char* end = begin;  // of what is no parameter
  for (; !rest.empty() && !has_next; skip_spaces(rest)) {
    auto word = take_word(rest);
    if (!word) return tl::make_unexpected(word.error());
    has_next = word->written == "|";
    if (has_next) continue;
    if (word->name.empty()) {  // the parameters before it are none
      element.parameters.clear();
      end = word->written.data() + word->written.size();
    } else {
      element.parameters.emplace_back(std::move(word->name), std::move(word->value));
    }
  }
  if (is_quoted && end != begin)
    return fail(Errc::bad_config,
                fmt::format("behind {} in quotes there is {}, which is no name=value",
                            quote(element.what), quote({begin, end})));
  if (!is_quoted) element.what = std::string(begin, end);
  if (auto settled = settle_kind(element); !settled) return tl::make_unexpected(settled.error());
  return element;
}

std::string in_quotes(std::string_view text) {
  std::string written = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') written += '\\';
    written += c;
  }
  return written + '"';
}

std::string print_element(const ContentElement& element) {
  std::string parameters;
  for (const auto& [name, value] : element.parameters) {
    const bool is_plain =
        !value.empty() && value.find(' ') == value.npos && !value.starts_with('"');
    parameters += fmt::format(" {}={}", name, is_plain ? value : in_quotes(value));
  }
  const std::string kind = element.kind == "pattern" ? "builtin" : element.kind;
  // The shortest text that is read as the same.
  for (const auto& written : {element.what, fmt::format("{}:{}", kind, element.what)}) {
    std::string_view rest = written;
    bool has_next = false;
    const auto read = take_element(rest, has_next);
    if (read && read->kind == element.kind && read->what == element.what &&
        read->parameters.empty() && !has_next)
      return written + parameters;
  }
  return kind + ":" + in_quotes(element.what) + parameters;
}

}  // namespace

Result<ContentChain> parse_content(std::string_view text) {
  ContentChain chain;
  for (bool has_next = true; has_next;) {
    auto element = take_element(text, has_next);
    if (!element) return tl::make_unexpected(element.error());
    chain.push_back(std::move(*element));
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
    if (element.kind == "view") {
      auto inner = resolve_content(element.what, folder);
      if (!inner) return inner;
      element.what = std::move(*inner);
    }
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
  const bool is_address = element.kind == "film" && element.what.find("://") != std::string::npos;
  return is_file_kind(element.kind) && !element.what.empty() && !is_address;
}

bool is_still(const ContentChain& chain) {
  return chain.size() == 1 && (chain[0].kind == "picture" || chain[0].kind == "pattern") &&
         chain[0].parameters.empty();
}

}  // namespace handcast::config
