// SPDX-License-Identifier: Apache-2.0
#include "config/settings/toml_fault.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <utility>
#include <vector>

#include "ipc/base/quote.hpp"
#include "ipc/base/suggest.hpp"
#include "ipc/base/text.hpp"

namespace handcast::config {

int column_of(std::string_view line, std::size_t at) {
  return 1 + static_cast<int>(std::ranges::count_if(line.substr(0, at), [](char c) {
           return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
         }));
}

namespace {

constexpr std::string_view kSpace = " \t\r";
constexpr std::size_t kLongestSentence = 300;  ///< bytes; it may quote the line
constexpr auto kNone = std::string_view::npos;

/// What a line probably means.
struct Guess {
  std::size_t at = 0;  ///< byte of the line at which the fault is
  std::string sentence;
};
using MaybeGuess = std::optional<Guess>;

bool is_name_char(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-';
}

/// The end of the string that begins at `begin`; kNone if it is not closed on its line.
std::size_t end_of_quoted(std::string_view line, std::size_t begin) {
  const char mark = line[begin];
  for (std::size_t i = begin + 1; i < line.size(); ++i) {
    if (line[i] == '\\' && mark == '"')
      ++i;
    else if (line[i] == mark)
      return i + 1;
  }
  return kNone;
}

/// The first byte outside of strings that is one of `wanted`, from `from` to the comment.
std::size_t find_outside(std::string_view line, std::string_view wanted, std::size_t from = 0) {
  for (std::size_t i = from; i < line.size();) {
    if (wanted.find(line[i]) != kNone) return i;
    if (line[i] == '#') return kNone;
    if (line[i] == '"' || line[i] == '\'') {
      i = end_of_quoted(line, i);
      if (i == kNone) return kNone;
    } else {
      ++i;
    }
  }
  return kNone;
}

/// The value that begins at `from`, without a comment and the spaces around it.
std::string_view value_from(std::string_view line, std::size_t from) {
  const auto comment = find_outside(line, "#", from);
  return trimmed(line.substr(from, comment == kNone ? kNone : comment - from));
}

struct Character {
  std::string_view bytes, name, instead;
};
constexpr std::array kWrongCharacters{Character{"\u201c", "a curly quote", "\""},
                                      Character{"\u201d", "a curly quote", "\""},
                                      Character{"\u201e", "a curly quote", "\""},
                                      Character{"\u201f", "a curly quote", "\""},
                                      Character{"\u00ab", "a pointed quote", "\""},
                                      Character{"\u00bb", "a pointed quote", "\""},
                                      Character{"\u2033", "a double prime", "\""},
                                      Character{"\uff02", "a wide quote", "\""},
                                      Character{"\u2018", "a curly quote", "'"},
                                      Character{"\u2019", "a curly quote", "'"},
                                      Character{"\u201a", "a curly quote", "'"},
                                      Character{"\u00b4", "an accent", "'"},
                                      Character{"`", "a backtick", "'"},
                                      Character{"\u00a0", "a no-break space", " "},
                                      Character{"\u202f", "a no-break space", " "},
                                      Character{"\u2009", "a thin space", " "},
                                      Character{"\u3000", "a wide space", " "},
                                      Character{"\u200b", "an invisible space", ""},
                                      Character{"\ufeff", "an invisible mark", ""},
                                      Character{"\u2212", "a minus sign", "-"},
                                      Character{"\u2013", "a dash", "-"},
                                      Character{"\u2014", "a dash", "-"},
                                      Character{"\uff1d", "a wide equals sign", "="}};

const Character* wrong_character_at(std::string_view line, std::size_t at) {
  const auto found = std::ranges::find_if(kWrongCharacters, [&](const Character& each) {
    return line.substr(at).starts_with(each.bytes);
  });
  return found == kWrongCharacters.end() ? nullptr : &*found;
}

std::string in_plain_characters(std::string_view line) {
  std::string plain;
  for (std::size_t i = 0; i < line.size();) {
    const auto* wrong = wrong_character_at(line, i);
    plain += wrong ? std::string(wrong->instead) : std::string(1, line[i]);
    i += wrong ? wrong->bytes.size() : 1;
  }
  return plain;
}

/// Characters that a word processor or a web page puts in the place of those of TOML.
MaybeGuess wrong_character(std::string_view line) {
  for (std::size_t i = 0; i < line.size() && line[i] != '#'; ++i) {
    if (line[i] == '"' || line[i] == '\'') {
      const auto end = end_of_quoted(line, i);
      if (end == kNone) return std::nullopt;
      i = end - 1;
    } else if (const auto* wrong = wrong_character_at(line, i)) {
      const auto plain = in_plain_characters(line);
      return Guess{i, fmt::format("{} stands here, as word processors and web pages write it; TOML "
                                  "has plain characters: {}",
                                  wrong->name, trimmed(plain))};
    }
  }
  return std::nullopt;
}

/// "[camera" and its relatives.
MaybeGuess section_line(std::string_view line, std::size_t begin) {
  const bool is_list = line.substr(begin).starts_with("[[");
  const auto name_at = begin + (is_list ? 2 : 1);
  auto name_end = name_at;
  while (name_end < line.size() && (is_name_char(line[name_end]) || line[name_end] == '.'))
    ++name_end;
  const auto name = line.substr(name_at, name_end - name_at);
  const auto header = fmt::format("{}{}{}", is_list ? "[[" : "[", name, is_list ? "]]" : "]");
  const auto rest = line.substr(name_end);
  const auto after = trimmed(rest.substr(0, rest.find('#')));
  const std::string_view close = is_list ? "]]" : "]";
  if (name.empty()) return Guess{begin, "the brackets of a section hold its name, as in [camera]"};
  if (after == close) return std::nullopt;
  if (after.empty() || after == ")" || after == "}")
    return Guess{name_end, "the closing bracket is missing: " + header};
  if (after.starts_with(close)) {
    const auto more = static_cast<std::size_t>(after.data() - line.data()) + close.size();
    return Guess{more, fmt::format("behind {} there must be nothing on this line; a setting has a "
                                   "line of its own",
                                   header)};
  }
  if (after.starts_with(']')) return Guess{name_end, "the closing brackets are missing: " + header};
  return Guess{name_end, fmt::format("the name of a section has only letters, digits, _ and dots, "
                                     "as in [camera.process]")};
}

/// A path or name with a backslash in double quotes.
MaybeGuess bad_escape(std::string_view line, std::size_t begin, std::string_view key) {
  constexpr std::string_view kEscapes = "btnfre\"\\uU";
  const auto end = end_of_quoted(line, begin);
  const auto text = line.substr(begin + 1, end == kNone ? kNone : end - begin - 2);
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    if (text[i] != '\\') continue;
    const char next = text[i + 1];
    // \U of C:\Users would need eight digits, \u of C:\usr four.
    const auto digits = text.substr(i + 2, next == 'U' ? 8 : 4);
    const bool is_unicode = (next == 'u' || next == 'U') &&
                            digits.size() == (next == 'U' ? 8u : 4u) &&
                            digits.find_first_not_of("0123456789abcdefABCDEF") == kNone;
    if (kEscapes.find(next) != kNone && next != 'e' &&
        (is_unicode || (next != 'u' && next != 'U'))) {
      ++i;
      continue;
    }
    return Guess{begin + 1 + i,
                 text.find('\'') == kNone
                     ? fmt::format("in double quotes, a backslash begins an escape; in single ones "
                                   "it stands for itself: {} = '{}'",
                                   key, trimmed(text))
                     : "in double quotes, a backslash begins an escape; write \\\\ for one"};
  }
  return std::nullopt;
}

MaybeGuess quoted_value(std::string_view line, std::size_t begin, std::string_view key) {
  if (line.substr(begin).starts_with("\"\"\"") || line.substr(begin).starts_with("'''"))
    return std::nullopt;
  const char mark = line[begin];
  if (mark == '"')
    if (auto escape = bad_escape(line, begin, key)) return escape;
  const auto end = end_of_quoted(line, begin);
  if (end == kNone) {
    auto text = trimmed(line.substr(begin + 1));
    const char other = mark == '"' ? '\'' : '"';
    if (text.ends_with(other)) text.remove_suffix(1);
    return Guess{line.size(),
                 fmt::format("the closing quote is missing: {} = {}{}{}", key, mark, text, mark)};
  }
  const auto rest = line.find_first_not_of(kSpace, end);
  if (rest == kNone || line[rest] == '#') return std::nullopt;
  const auto more = value_from(line, rest);
  if (more == ";" || more == ",")
    return Guess{rest, fmt::format("a line ends without {}", quote(more))};
  if (mark == '\'' && line.find('\'', end) != kNone)
    return Guess{end - 1,
                 fmt::format("text with an apostrophe needs double quotes: {} = \"…\"", key)};
  if (mark == '"' && line.find('"', end) != kNone)
    return Guess{rest, fmt::format("text ends at its second quote; a quote inside it is written "
                                   "\\\", and several texts are a list: {} = [\"a\", \"b\"]",
                                   key)};
  return Guess{rest, "behind a value there may only be a comment, which begins with #"};
}

MaybeGuess list_value(std::string_view line, std::size_t begin, std::string_view key) {
  int open = 0;
  std::size_t last = begin;
  for (std::size_t i = begin; (i = find_outside(line, "[]", i)) != kNone; ++i) {
    open += line[i] == '[' ? 1 : -1;
    last = i;
  }
  const auto inside = value_from(line, begin + 1);
  if (open > 0)
    return Guess{line.size(),
                 fmt::format("the closing bracket of the list is missing: {} = [{}]", key, inside)};
  const auto rest = value_from(line, last + 1);
  if (open == 0 && !rest.empty())
    return Guess{last + 1, rest == ";" || rest == ","
                               ? fmt::format("a line ends without {}", quote(rest))
                               : "behind a list there may only be a comment, which begins with #"};
  const auto elements = line.substr(begin + 1, last > begin ? last - begin - 1 : 0);
  const auto bare = elements.find_first_not_of(" \t0123456789.,+-eE_[]");
  const bool has_words = find_outside(elements, "\"'") == kNone && bare != kNone;
  if (has_words)
    return Guess{begin + 1 + bare,
                 fmt::format("the texts of a list need quotes: {} = [\"…\", \"…\"]", key)};
  if (elements.find(',') == kNone || elements.find(';') != kNone)
    return Guess{
        begin, fmt::format("the elements of a list have commas between them: {} = [1, 2, 3]", key)};
  return std::nullopt;
}

/// The true or false that a word stands for in other languages; "" for others.
std::string_view flag_of(std::string_view word) {
  std::string small(word);
  std::ranges::transform(small, small.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const std::string_view yes : {"true", "yes", "on"})
    if (small == yes) return "true";
  for (const std::string_view no : {"false", "no", "off"})
    if (small == no) return "false";
  return "";
}

MaybeGuess bare_value(std::string_view line, std::size_t begin, std::string_view key) {
  auto value = value_from(line, begin);
  const auto at_end = begin + value.size() - 1;
  if (value.size() > 1 && (value.ends_with(';') || value.ends_with(',')))
    return Guess{at_end, fmt::format("a line ends without '{}': {} = {}", value.back(), key,
                                     trimmed(value.substr(0, value.size() - 1)))};
  if (const auto flag = flag_of(value); !flag.empty() && flag != value)
    return Guess{begin, fmt::format("write {} = {}", key, flag)};
  if (const auto meant = meant_number(value); !meant.empty()) return Guess{begin, meant};
  const auto quotes = value.find_first_of("\"'");
  if (quotes != kNone)
    return value.ends_with(value[quotes]) && value.find(value[quotes]) == value.size() - 1
               ? Guess{begin, fmt::format("the opening quote is missing: {} = {}{}", key,
                                          value[quotes], value)}
               : Guess{begin + quotes, "a quote stands where none is expected"};
  if (value.starts_with('-') || value.starts_with('+'))
    return Guess{begin, fmt::format("{} is not a number", quote(value))};
  return Guess{begin,
               value.find('\\') == kNone
                   ? fmt::format("text needs quotes: {} = \"{}\"", key, value)
                   : fmt::format("text needs quotes, and with backslashes single ones: {} = '{}'",
                                 key, value)};
}

/// A line with no = outside of strings.
MaybeGuess line_without_equals(std::string_view line, std::size_t begin) {
  const auto text = line.substr(begin);
  for (const std::string_view comment : {";", "//", "--", "/*", "%", "REM ", "!"})
    if (text.starts_with(comment)) return Guess{begin, "a comment begins with #"};
  if ((text.starts_with('(') || text.starts_with('{') || text.starts_with('<')))
    return Guess{begin, "a section is written in square brackets, as in [camera]"};
  auto end = begin;
  while (end < line.size() && (is_name_char(line[end]) || line[end] == '.')) ++end;
  const auto key = line.substr(begin, end - begin);
  const auto next = std::min(line.find_first_not_of(kSpace, end), line.size());
  if (key.empty() || next == line.size())
    return Guess{begin, line.find(']') != kNone && line.find('[') == kNone
                            ? "the opening bracket is missing: [" + std::string(key) + "]"
                            : "a line is a setting (name = value), a section ([camera]) or a "
                              "comment (# ...)"};
  if (line[next] == ']')
    return Guess{begin, fmt::format("the opening bracket is missing: [{}]", key)};
  if (line[next] == ':')
    return Guess{next, fmt::format("between a name and its value there is = and not ':': {} = {}",
                                   key, value_from(line, next + 1))};
  return Guess{next, fmt::format("= is missing between name and value: {} = {}", key,
                                 value_from(line, next))};
}

MaybeGuess faulty_key(std::string_view line, std::size_t begin, std::size_t equals) {
  const auto key = trimmed(line.substr(begin, equals - begin));
  if (key.empty()) return Guess{equals, "the name of the setting is missing before ="};
  if (key.ends_with(':') || key.ends_with('+'))
    return Guess{equals - 1, "between a name and its value there is = alone"};
  if (key.find_first_of("\"'") != kNone) return std::nullopt;
  for (std::size_t i = 0; i < key.size(); ++i)
    if (!is_name_char(key[i]) && key[i] != '.') {
      if (key[i] == ' ') {
        const auto dot = key.find_first_not_of(' ', i);  // "a . b" is allowed
        if (dot != kNone && (key[dot] == '.' || (i > 0 && key[i - 1] == '.'))) continue;
        return Guess{begin + i, fmt::format("the name of a setting has no spaces: {}", quote(key))};
      }
      return Guess{begin + i, fmt::format("the name of a setting has only letters, digits, _ and "
                                          "dots: {}",
                                          quote(key))};
    }
  return std::nullopt;
}

MaybeGuess guess_line(std::string_view line) {
  const auto begin = line.find_first_not_of(kSpace);
  if (begin == kNone || line[begin] == '#') return std::nullopt;
  if (auto guess = wrong_character(line)) return guess;
  if (line[begin] == '[') return section_line(line, begin);
  const auto equals = find_outside(line, "=", begin);
  if (equals == kNone) return line_without_equals(line, begin);
  if (auto guess = faulty_key(line, begin, equals)) return guess;
  const auto key = trimmed(line.substr(begin, equals - begin));
  const auto value = line.find_first_not_of(kSpace, equals + 1);
  if (value != kNone && line[value] == '=')
    return Guess{value, "between a name and its value there is one ="};
  if (value == kNone || line[value] == '#')
    return Guess{equals + 1, fmt::format("the value is missing behind {} =", key)};
  if (line[value] == '"' || line[value] == '\'') return quoted_value(line, value, key);
  if (line[value] == '[') return list_value(line, value, key);
  if (line[value] == '{') return std::nullopt;
  const auto bare = value_from(line, value);
  const bool is_fine =
      bare == "true" || bare == "false" ||
      (meant_number(bare).empty() && bare.find_first_not_of("0123456789") == kNone);
  return is_fine ? std::nullopt : bare_value(line, value, key);
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  for (;;) {
    const auto end = text.find('\n');
    lines.push_back(text.substr(0, end));
    if (lines.back().ends_with('\r')) lines.back().remove_suffix(1);
    if (end == kNone) return lines;
    text.remove_prefix(end + 1);
  }
}

/// The name before = or between the brackets of a line; "" for others.
std::string name_in(std::string_view line) {
  const auto text = trimmed(line);
  if (text.starts_with('[')) return std::string(text.substr(0, text.find(']') + 1));
  const auto equals = find_outside(text, "=");
  return equals == kNone ? "" : std::string(trimmed(text.substr(0, equals)));
}

/// A section or a setting that is there a second time.
MaybeGuess repetition(const std::vector<std::string_view>& lines, std::size_t at) {
  const auto name = name_in(lines[at]);
  if (name.empty()) return std::nullopt;
  const auto begin = std::min(lines[at].find_first_not_of(kSpace), lines[at].size());
  if (name.starts_with('[')) {
    const auto dotted = name.substr(1, name.size() - 2) + ".";
    for (std::size_t i = 0; i < at; ++i) {
      const auto other = name_in(lines[i]);
      if (other == name || "[" + other + "]" == name)
        return Guess{begin, fmt::format("{} is there already, at line {}; a section is there once: "
                                        "put these settings into that one",
                                        name, i + 1)};
      if (other.starts_with(dotted))
        return Guess{begin,
                     fmt::format("line {} sets {} already; put it into the section", i + 1, other)};
    }
    return std::nullopt;
  }
  for (std::size_t i = at; i-- > 0;) {
    if (name_in(lines[i]) == name)
      return Guess{
          begin, fmt::format("{} is set already, at line {}; remove one of the two", name, i + 1)};
    if (trimmed(lines[i]).starts_with('[')) break;
  }
  return std::nullopt;
}

std::size_t byte_of_column(std::string_view line, int column) {
  std::size_t at = 0;
  for (; at < line.size() && column_of(line, at) < column; ++at) {
  }
  return std::min(at, line.size());
}

/// The part of a line around a byte, and the caret below it.
std::string with_caret(std::string_view line, std::size_t at) {
  constexpr std::size_t kBefore = 60, kShown = 100;
  const auto is_inside = [&](std::size_t i) {
    return i < line.size() && (static_cast<unsigned char>(line[i]) & 0xc0) == 0x80;
  };
  auto from = at > kBefore && line.size() > kShown ? at - kBefore : 0;
  while (is_inside(from)) --from;
  auto to = std::min(from + kShown, line.size());
  while (is_inside(to)) --to;
  std::string shown(from > 0 ? "…" : "");
  std::string below(from > 0 ? " " : "");
  for (std::size_t i = from; i < to; ++i) {
    const auto byte = static_cast<unsigned char>(line[i]);
    shown += byte < 0x20 || byte == 0x7f ? ' ' : line[i];
    if (i < at && !is_inside(i)) below += ' ';
  }
  return fmt::format("\n    {}{}\n    {}^", shown, to < line.size() ? "…" : "", below);
}

std::string message(std::string_view file, const std::vector<std::string_view>& lines,
                    std::size_t line, const Guess& guess) {
  return fmt::format("{}:{}:{}: {}{}", file, line + 1, column_of(lines[line], guess.at),
                     shown_line(guess.sentence, kLongestSentence),
                     with_caret(lines[line], guess.at));
}

}  // namespace

std::string toml_fault(std::string_view toml, std::string_view file, TextPlace refused,
                       std::string_view parsers_words) {
  if (toml.starts_with("\xef\xbb\xbf")) toml.remove_prefix(3);
  const auto lines = lines_of(toml);
  const auto at = std::min<std::size_t>(std::max(refused.line, 1) - 1, lines.size() - 1);
  if (parsers_words.find("redefine") != kNone || parsers_words.find("already") != kNone)
    if (const auto twice = repetition(lines, at)) return message(file, lines, at, *twice);
  if (const auto guess = guess_line(lines[at])) return message(file, lines, at, *guess);
  // A list or a string that is not closed is refused at what follows.
  for (std::size_t before = at; before-- > 0;) {
    const auto text = trimmed(lines[before]);
    if (text.empty() || text.starts_with('#')) continue;
    if (const auto guess = guess_line(lines[before])) return message(file, lines, before, *guess);
    if (find_outside(text, "=") != kNone || text.starts_with('[')) break;
  }
  return message(
      file, lines, at,
      {byte_of_column(lines[at], refused.column), fmt::format("not TOML: {}", parsers_words)});
}

}  // namespace handcast::config
