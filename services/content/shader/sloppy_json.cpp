// SPDX-License-Identifier: Apache-2.0
#include "services/content/shader/sloppy_json.hpp"

#include <fmt/format.h>

#include <cctype>

#include "ipc/base/quote.hpp"

namespace handcast::content::shader {
namespace {

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

class Strictener {
 public:
  explicit Strictener(std::string_view text) : text_(text) {}

  std::string run() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"') {
        word();
      } else if (text_.substr(at_, 2) == "//" || text_.substr(at_, 2) == "/*") {
        comment();
      } else if (is_digit(c) || c == '.' || c == '+' || c == '-') {
        number();
      } else if (c == ']' || c == '}') {
        drop_comma();
        put(c);
      } else {
        put(c);
      }
    }
    return std::move(out_);
  }

 private:
  void put(char c) {
    out_ += c;
    ++at_;
  }

  void word() {
    put('"');
    while (at_ < text_.size() && text_[at_] != '"') {
      const char c = text_[at_];
      if (c == '\\') {
        escape();
      } else if (c == '\n') {
        // The line stays a line for the messages only where no text is open; it is a rare thing.
        out_ += "\\n", ++at_;
      } else if (static_cast<unsigned char>(c) < 0x20) {
        out_ += fmt::format("\\u{:04x}", static_cast<int>(c)), ++at_;
      } else if (const auto bytes = bytes_of_character(text_.substr(at_)); bytes > 1) {
        out_ += text_.substr(at_, bytes), at_ += bytes;
      } else if (bytes == 0) {
        out_ += '?', ++at_;
      } else {
        put(c);
      }
    }
    if (at_ < text_.size()) put('"');
  }

  void escape() {
    const char next = at_ + 1 < text_.size() ? text_[at_ + 1] : '\0';
    if (next != '\0' && std::string_view("\"\\/bfnrtu").find(next) != std::string_view::npos) {
      put('\\');
      put(next);
    } else {
      out_ += "\\\\";
      ++at_;
    }
  }

  void comment() {
    const bool is_line = text_[at_ + 1] == '/';
    const auto end = text_.find(is_line ? "\n" : "*/", at_ + 2);
    const auto stop = end == text_.npos ? text_.size() : end + (is_line ? 0 : 2);
    for (; at_ < stop; ++at_) out_ += text_[at_] == '\n' ? '\n' : ' ';
  }

  void number() {
    if (text_[at_] == '+') ++at_;
    if (at_ < text_.size() && text_[at_] == '-') put('-');
    if (at_ < text_.size() && text_[at_] == '.') out_ += '0';
    while (at_ + 1 < text_.size() && text_[at_] == '0' && is_digit(text_[at_ + 1])) ++at_;
    while (at_ < text_.size() && is_digit(text_[at_])) put(text_[at_]);
    if (at_ < text_.size() && text_[at_] == '.') {
      put('.');
      if (at_ >= text_.size() || !is_digit(text_[at_])) out_ += '0';
      while (at_ < text_.size() && is_digit(text_[at_])) put(text_[at_]);
    }
    if (at_ < text_.size() && (text_[at_] == 'e' || text_[at_] == 'E')) {
      put('e');
      if (at_ < text_.size() && (text_[at_] == '+' || text_[at_] == '-')) put(text_[at_]);
      while (at_ < text_.size() && is_digit(text_[at_])) put(text_[at_]);
    }
    if (at_ < text_.size() && text_[at_] == 'f') ++at_;
  }

  /// Blanks a comma that only white space follows.
  void drop_comma() {
    const auto last = out_.find_last_not_of(" \t\r\n");
    if (last != out_.npos && out_[last] == ',') out_[last] = ' ';
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::string out_;
};

}  // namespace

std::string strict_json(std::string_view text) { return Strictener(text).run(); }

}  // namespace handcast::content::shader
