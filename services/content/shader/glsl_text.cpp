// SPDX-License-Identifier: Apache-2.0
#include "services/content/shader/glsl_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

namespace handcast::content::shader {
namespace {

/// Words that GLSL keeps for later, but which older versions gave away, and those that no shader
/// for one picture needs.
constexpr auto kReserved = std::to_array<std::string_view>(
    {"active",    "asm",       "buffer",     "cast",      "class",    "common", "enum",
     "extern",    "external",  "filter",     "fixed",     "goto",     "half",   "inline",
     "input",     "interface", "long",       "namespace", "noinline", "output", "packed",
     "partition", "patch",     "public",     "resource",  "sample",   "shared", "short",
     "sizeof",    "static",    "subroutine", "superp",    "template", "this",   "typedef",
     "union",     "unsigned",  "using"});

/// Words that are part of the language, which only the name of an input may replace.
constexpr auto kWords = std::to_array<std::string_view>(
    {"smooth",    "flat",   "centroid", "noperspective", "invariant", "uniform", "varying",
     "attribute", "const",  "in",       "out",           "inout",     "float",   "int",
     "bool",      "uint",   "double",   "vec2",          "vec3",      "vec4",    "mat2",
     "mat3",      "mat4",   "switch",   "case",          "default",   "if",      "else",
     "for",       "while",  "do",       "break",         "continue",  "return",  "discard",
     "struct",    "void",   "true",     "false",         "precision", "highp",   "mediump",
     "lowp",      "layout", "main",     "texture",       "sampler2D"});

bool is_word_start(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }
bool is_word_part(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

/// The text without comments, in ASCII; line ends are "\n".
std::string without_comments(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  std::string out;
  out.reserve(text.size() + 1);
  for (std::size_t i = 0; i < text.size();) {
    if (text.substr(i, 2) == "//") {
      while (i < text.size() && text[i] != '\n' && text[i] != '\r') ++i;
    } else if (text.substr(i, 2) == "/*") {
      const auto end = std::min(text.find("*/", i + 2), text.size());
      out += ' ';
      for (; i < end; ++i)
        if (text[i] == '\n') out += '\n';
      i = std::min(end + 2, text.size());
    } else if (text[i] == '\r') {
      if (text.substr(i + 1, 1) != "\n") out += '\n';
      ++i;
    } else {
      out += static_cast<unsigned char>(text[i]) < 0x80 && text[i] != '\0' ? text[i] : ' ';
      ++i;
    }
  }
  out += '\n';
  return out;
}

/// Takes a line "#word ..." out of the text; the line stays, empty. Returns the lines.
std::string take_directives(std::string& text, std::string_view word) {
  std::string taken;
  for (std::size_t begin = 0; begin < text.size();) {
    const auto end = std::min(text.find('\n', begin), text.size());
    const auto hash = text.find_first_not_of(" \t", begin);
    if (hash < end && text[hash] == '#') {
      const auto name = text.find_first_not_of(" \t", hash + 1);
      if (name < end && std::string_view(text).substr(name).starts_with(word)) {
        taken += text.substr(begin, end - begin) + "\n";
        std::fill(text.begin() + static_cast<std::ptrdiff_t>(begin),
                  text.begin() + static_cast<std::ptrdiff_t>(end), ' ');
      }
    }
    begin = end + 1;
  }
  return taken;
}

/// An identifier in a text.
struct Word {
  std::size_t begin, length;
};

std::vector<Word> words_of(std::string_view text) {
  std::vector<Word> words;
  for (std::size_t i = 0; i < text.size();) {
    if (is_word_start(text[i])) {
      const auto begin = i;
      while (i < text.size() && is_word_part(text[i])) ++i;
      words.push_back({begin, i - begin});
    } else if (std::isdigit(static_cast<unsigned char>(text[i]))) {
      while (i < text.size() && (is_word_part(text[i]) || text[i] == '.')) ++i;  // 1.0e3, 0xff, 1u
    } else {
      ++i;
    }
  }
  return words;
}

/// The name in "out vec4 NAME;".
std::string declared_output(std::string_view text, const std::vector<Word>& words) {
  for (std::size_t i = 0; i + 2 < words.size(); ++i) {
    if (text.substr(words[i].begin, words[i].length) != "out") continue;
    std::size_t type = i + 1;
    const auto word = [&](std::size_t k) { return text.substr(words[k].begin, words[k].length); };
    while (type + 1 < words.size() && word(type).ends_with("p") && word(type) != "vec4") ++type;
    if (type + 1 >= words.size() || word(type) != "vec4") continue;
    const auto& name = words[type + 1];
    const auto next = text.find_first_not_of(" \t\n", name.begin + name.length);
    if (next != text.npos && text[next] == ';') return std::string(word(type + 1));
  }
  return {};
}

}  // namespace

bool is_glsl_word(std::string_view name) {
  return std::ranges::find(kWords, name) != kWords.end() ||
         std::ranges::find(kReserved, name) != kReserved.end();
}

GlslText read_glsl(std::string_view text, const std::set<std::string, std::less<>>& renamed) {
  GlslText glsl;
  const std::string plain = [&] {
    auto lines = without_comments(text);
    take_directives(lines, "version");
    glsl.extensions = take_directives(lines, "extension");
    return lines;
  }();
  const auto words = words_of(plain);
  std::size_t copied = 0;
  for (const Word& word : words) {
    const auto name = std::string_view(plain).substr(word.begin, word.length);
    glsl.words.emplace(name);
    const bool is_bad = name == "main" || renamed.contains(name) ||
                        std::ranges::find(kReserved, name) != kReserved.end();
    if (!is_bad) continue;
    glsl.text += plain.substr(copied, word.begin - copied);
    glsl.text += kPrefix;
    copied = word.begin;
  }
  glsl.text += plain.substr(copied);
  glsl.output = declared_output(plain, words);
  if (glsl.output.empty()) glsl.output = glsl.mentions("gl_FragData") ? "gl_FragData[0]" : "";
  if (glsl.output.empty() && !glsl.mentions("out")) glsl.output = "gl_FragColor";
  if (glsl.output.empty() && glsl.mentions("gl_FragColor")) glsl.output = "gl_FragColor";
  return glsl;
}

}  // namespace handcast::content::shader
