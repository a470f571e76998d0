// SPDX-License-Identifier: Apache-2.0
#include "config/settings/file_kind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "config/settings/toml_fault.hpp"
#include "ipc/base/quote.hpp"

namespace handcast::config {
namespace {

struct Magic {
  std::string_view begin, kind;
};
constexpr std::array kOthers{Magic{"\x89PNG", "a PNG picture"},
                             Magic{"\xff\xd8\xff", "a JPEG picture"},
                             Magic{"PK\x03\x04", "a ZIP archive or an office document"},
                             Magic{"%PDF", "a PDF document"},
                             Magic{"{\\rtf", "formatted text (RTF); save it as plain text"},
                             Magic{"glTF", "a glTF model"},
                             Magic{"\x93NUMPY", "a NumPy array"},
                             Magic{"RIFF", "a film or a sound"},
                             Magic{"\x7f"
                                   "ELF",
                                   "a program"},
                             Magic{"\x1f\x8b", "a compressed file"},
                             Magic{"%YAML", "YAML"},
                             Magic{"<", "a web page, or XML"},
                             Magic{"{", "JSON"}};

/// The place of a byte of a text.
std::string at_byte(std::string_view file, std::string_view text, std::size_t at) {
  const auto before = text.substr(0, at);
  const auto line = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
  return fmt::format("{}:{}:{}", file, 1 + std::ranges::count(before, '\n'),
                     column_of(text.substr(line), at - line));
}

/// The first byte that is not part of a UTF-8 character; std::string_view::npos if all are.
std::size_t first_not_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto count = bytes_of_character(text.substr(i));
    if (count == 0) return i;
    i += count;
  }
  return std::string_view::npos;
}

}  // namespace

std::string why_unreadable(std::string_view toml) {
  const auto at = first_not_utf8(toml);
  if (at == toml.npos) return {};
  const auto begin = toml.rfind('\n', at) + 1;  // 0 in the first line
  return fmt::format("{}: is not UTF-8; write it in UTF-8, and rename a folder whose name is not",
                     quote(toml.substr(begin, toml.find('\n', at) - begin)));
}

std::string other_kind_of_file(std::string_view text, std::string_view file) {
  const bool has_mark = text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff");
  const bool is_wide =
      text.size() > 3 && text.size() % 2 == 0 && text[0] != 0 && text[1] == 0 && text[3] == 0;
  if (has_mark || is_wide)
    return fmt::format(
        "{}:1:1: the file is in UTF-16, as some editors of Windows write it; save it "
        "as UTF-8",
        file);
  const auto begin = text.substr(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  for (const auto& [magic, kind] : kOthers)
    if (begin.starts_with(magic))
      return fmt::format("{}:1:1: this is no TOML file, but {}", file, kind);
  if (const auto at = text.find('\0'); at != std::string_view::npos)
    return at_byte(file, text, at) + ": this is no text file: it has a byte 0";
  if (const auto at = first_not_utf8(text); at != std::string_view::npos)
    return fmt::format(
        "{}: the byte {:#04x} is not UTF-8; the file was saved in another encoding "
        "(Latin-1, Windows-1252): save it as UTF-8",
        at_byte(file, text, at), static_cast<unsigned char>(text[at]));
  const auto carriage = text.find('\r');
  if (carriage != std::string_view::npos && text.find('\n') == std::string_view::npos)
    return fmt::format(
        "{}:1:{}: the lines end with carriage returns alone, as on old Macs; save "
        "the file with the line ends of Unix",
        file, carriage + 1);
  return {};
}

}  // namespace handcast::config
