// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::config {

/// One source or filter of a content.
struct ContentElement {
  std::string kind;  ///< "picture", "film", "isf", …; of a plain name, "look"
  std::string what;  ///< a file, an address, a text or a name
  std::vector<std::pair<std::string, std::string>> parameters;  ///< name and value, in their order
};

/// Content as it is written in a rig file or a command: sources and filters, from the lowest up.
///
///     chain      = element *( " | " element )
///     element    = [ kind ":" ] what *( " " name "=" value )
///
/// "film:a.mp4 speed=0.5 | isf:kaleidoscope.fs sides=6 | text:Hello colour=#ff8800 opacity=0.5".
/// `what` may have spaces. It is put in double quotes if it ends with what looks like a parameter
/// or has a bar between spaces, and so is a value with spaces; within quotes, \" and \\ stand for "
/// and \. Without a kind, the end of a file's name says it
/// (content_kind_of()); a name without an end is a look. "builtin:NAME" is "pattern:NAME". `what`
/// of the kind view is itself an element.
using ContentChain = std::vector<ContentElement>;

/// Reads it. Errors (bad_config), each a sentence: it or an element is empty, a quote is not
/// closed.
Result<ContentChain> parse_content(std::string_view text);
/// Writes it in the shortest way, so that parse_content() reads the same.
std::string print_content(const ContentChain& chain);

/// The same chain with the paths of its files absolute: those that are relative start at `folder`,
/// ~ is the home folder. Errors (bad_config): those of parse_content(), a path that cannot be one.
Result<std::string> resolve_content(std::string_view text, const std::filesystem::path& folder);

/// The kind of content in a file by the end of its name: picture, film, isf, shadertoy; "capture"
/// for /dev/video0, "film" for an address ("rtsp://…"), "picture" for another path; "" for a name.
std::string_view content_kind_of(std::string_view file);
/// True if `what` of this kind is the path of a file.
bool is_content_file(const ContentElement& element);
/// True for one picture or pattern alone, which needs no content service: a PNG or JPEG file,
/// "builtin:atlas".
bool is_still(const ContentChain& chain);

}  // namespace handcast::config
