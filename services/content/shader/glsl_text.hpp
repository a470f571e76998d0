// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <set>
#include <string>
#include <string_view>

namespace handcast::content::shader {

/// The text of a person's shader, made fit for a driver. Each line stays on its line.
struct GlslText {
  std::string text;        ///< without comments, `#version` and `#extension`; names as below
  std::string extensions;  ///< its `#extension` lines
  std::set<std::string, std::less<>> words;  ///< its identifiers, as the person wrote them
  std::string output;  ///< what it writes its colour to, e.g. "gl_FragColor"; "" if that is unknown

  bool mentions(std::string_view word) const { return words.contains(word); }
};

/// Its function main() is kMain, and names that GLSL reserves, or that are in `renamed` (inputs
/// named like a keyword), begin with kPrefix.
GlslText read_glsl(std::string_view text, const std::set<std::string, std::less<>>& renamed = {});

/// The prefix of names that would not compile, and the person's main() in it.
inline constexpr std::string_view kPrefix = "hc_", kMain = "hc_main";

/// True if a name of an input, as it is, would be taken for a word of GLSL.
bool is_glsl_word(std::string_view name);

}  // namespace handcast::content::shader
