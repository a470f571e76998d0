// SPDX-License-Identifier: Apache-2.0
#include "config/settings/toml_fault.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/settings/document.hpp"
#include "config/settings/file_kind.hpp"

namespace handcast::config {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::string fault_of(const std::string& toml) {
  const auto document = parse_document(toml, "rig.toml");
  return document ? "none" : document.error().what;
}

TEST(TomlFault, ShowsPlaceMeaningLineAndCaret) {
  EXPECT_EQ(fault_of("[camera]\n\nbackend = window # the beamer\n"),
            "rig.toml:3:11: text needs quotes: backend = \"window\"\n"
            "    backend = window # the beamer\n"
            "              ^");
}

TEST(TomlFault, TheCaretStandsBelowItsCharacter) {
  EXPECT_EQ(fault_of("\tname = \xc3\xa4\xc3\xb6 \xe2\x80\x9cx\xe2\x80\x9d\n").substr(0, 15),
            "rig.toml:1:12: ")
      << "columns count characters";
  EXPECT_THAT(fault_of("\tname = \xc3\xa4\xc3\xb6 \xe2\x80\x9cx\xe2\x80\x9d\n"),
              testing::EndsWith(
                  "\n     name = \xc3\xa4\xc3\xb6 \xe2\x80\x9cx\xe2\x80\x9d\n               ^"));
}

struct Case {
  std::string toml, meant;
};

TEST(TomlFault, SaysWhatWasProbablyMeant) {
  const Case cases[] = {
      // Text.
      {"backend = window", "rig.toml:1:11: text needs quotes: backend = \"window\""},
      {"left = pictures/my hand.png", "text needs quotes: left = \"pictures/my hand.png\""},
      {"mode = 1280x800", "text needs quotes: mode = \"1280x800\""},
      {"device = 192.168.0.5", "text needs quotes: device = \"192.168.0.5\""},
      {"left = C:\\a.png", "single ones: left = 'C:\\a.png'"},
      {"left = \"C:\\Users\\me\\a.png\"", "it stands for itself: left = 'C:\\Users\\me\\a.png'"},
      {"left = \"a\\d\"", "a backslash begins an escape"},
      {"backend = \"window", "the closing quote is missing: backend = \"window\""},
      {"backend = 'window\"", "the closing quote is missing: backend = 'window'"},
      {"backend = window\"", "the opening quote is missing: backend = \"window\""},
      {"backend = \"window\";", "a line ends without ';'"},
      {"backend = \"window\",", "a line ends without ','"},
      {"backend = \"a\" \"b\"", "several texts are a list"},
      {"name = 'it's'", "an apostrophe needs double quotes"},
      {"backend = \u201cwindow\u201d", "curly quote stands here"},
      {"backend = \u201cwindow\u201d", "plain characters: backend = \"window\""},
      {"backend = \u201ewindow\u201c", "plain characters: backend = \"window\""},
      {"backend = \u2018window\u2019", "plain characters: backend = 'window'"},
      {"backend =\u00a0\"window\"", "a no-break space"},
      // Numbers, true and false.
      {"rate_hz = 60 Hz", "rig.toml:1:11: write the number alone, without 'Hz'"},
      {"rate_hz = 60Hz", "write the number alone, without 'Hz'"},
      {"rate_hz = 60,5", "write 60.5, with a decimal point"},
      {"rate_hz = 60,5 # Hz", "write 60.5, with a decimal point"},
      {"brightness = 50%", "write 0.5: a share is a number"},
      {"brightness = .5", "write 0.5"},
      {"rate_hz = 060", "write 60"},
      {"rate_hz = 1'000", "write 1000"},
      {"rate_hz = 60;", "a line ends without ';': rate_hz = 60"},
      {"rate_hz = 60,", "a line ends without ',': rate_hz = 60"},
      {"x_mm = \u22125", "a minus sign stands here"},
      {"loop = True", "write loop = true"},
      {"loop = yes", "write loop = true"},
      {"loop = Off", "write loop = false"},
      {"rate_hz =", "the value is missing"},
      {"rate_hz = # Hz", "the value is missing"},
      // Lists.
      {"cores = [1, 2\nrate_hz = 60", "rig.toml:1:14: the closing bracket of the list is missing"},
      {"cores = [1 2]", "commas between them"},
      {"features = [a, b]", "the texts of a list need quotes"},
      // Lines.
      {"rate_hz: 60", "there is = and not ':': rate_hz = 60"},
      {"rate_hz 60", "= is missing between name and value: rate_hz = 60"},
      {"rate_hz == 60", "there is one ="},
      {"rate_hz := 60", "there is = alone"},
      {"rate hz = 60", "has no spaces"},
      {"h\u00f6he = 60", "only letters, digits, _ and dots"},
      {"= 60", "the name of the setting is missing"},
      {"; a comment", "a comment begins with #"},
      {"// a comment", "a comment begins with #"},
      {"hello", "a line is a setting (name = value), a section"},
      // Sections.
      {"[camera\nrate_hz = 60", "rig.toml:1:8: the closing bracket is missing: [camera]"},
      {"camera]\nrate_hz = 60", "the opening bracket is missing: [camera]"},
      {"[camera] rate_hz = 60", "a setting has a line of its own"},
      {"(camera)", "a section is written in square brackets"},
      {"[[camera]", "the closing brackets are missing: [[camera]]"},
      {"[camera one]", "the name of a section has only letters"},
      {"[]", "the brackets of a section hold its name"},
      {"[camera]\na = 1\n[pose]\nb = 1\n[camera]\nc = 1",
       "rig.toml:5:1: [camera] is there already, at line 1"},
      {"[camera]\na = 1\nb = 2\na = 3\n", "rig.toml:4:1: a is set already, at line 2"},
      {"camera.a = 1\n[camera]\nb = 2\n", "line 1 sets camera.a already"},
  };
  for (const auto& [toml, meant] : cases) {
    const auto fault = fault_of(toml + "\n");
    EXPECT_THAT(fault, AllOf(StartsWith("rig.toml:"), HasSubstr(meant), HasSubstr("\n    "),
                             Not(HasSubstr("not TOML"))))
        << toml;
  }
}

TEST(TomlFault, WhatIsTomlStays) {
  for (const auto* toml :
       {"\xef\xbb\xbf[camera]\r\nrate_hz = 60\r\n", "\tname\t=\t'a'\t# a \u201cgood\u201d name\n",
        "a = \"\u201ca\u201d\"\n", "a = '''\nx = y\n'''\n", "a = [\n  1,\n  2, # two\n]\n",
        "a . b = 1\n", "a = -0.5e-3\nb = 1_000\nc = 0x10\nd = 2026-11-27\n", "", "# nothing\n"})
    EXPECT_EQ(fault_of(toml), "none") << toml;
}

TEST(TomlFault, AFileOfAnotherKindOrEncodingIsNamed) {
  using namespace std::string_literals;
  const auto wide = [](std::string_view text) {
    std::string bytes;
    for (const char c : text) bytes += {c, '\0'};
    return bytes;
  };
  EXPECT_THAT(fault_of("\xff\xfe" + wide("a = 1\n")), HasSubstr("UTF-16"));
  EXPECT_THAT(fault_of(wide("a = 1\n")), HasSubstr("UTF-16"));
  EXPECT_THAT(fault_of("\xfe\xff\0a"s), HasSubstr("save it as UTF-8"));
  EXPECT_THAT(fault_of("a = 1\nb = \"sch\xf6n\"\n"),
              AllOf(StartsWith("rig.toml:2:9: "), HasSubstr("0xf6"), HasSubstr("Latin-1")));
  EXPECT_THAT(fault_of("a = 1\rb = 2\r"), HasSubstr("carriage returns"));
  EXPECT_THAT(fault_of("\x89PNG\r\n\x1a\n\0\0"s), HasSubstr("a PNG picture"));
  EXPECT_THAT(fault_of("<!DOCTYPE html>\n"), HasSubstr("a web page"));
  EXPECT_THAT(fault_of("{\"camera\": 1}\n"), HasSubstr("JSON"));
  EXPECT_THAT(fault_of("{\\rtf1 a = 1}\n"), HasSubstr("save it as plain text"));
  EXPECT_THAT(fault_of("a = 1\n\0"s), HasSubstr("it has a byte 0"));
}

TEST(TomlFault, NeverPrintsTheFile) {
  for (const std::string start : {"a = ", "a = \"", "a", "[", "a = [", "\"", "{", "a = b\\", "é"}) {
    const auto fault = fault_of(start + std::string(838'000, 'A') + "\x1b[2J\n");
    EXPECT_LT(fault.size(), 1200u) << start;
    EXPECT_EQ(fault.find('\x1b'), std::string::npos) << start;
  }
}

TEST(TomlFault, AnythingIsAnsweredWithinTheText) {
  const std::string pieces[] = {"a", "=", "\"", "'", "[", "]", "\\",     "#",  ".", ",",
                                " ", "1", "\n", "{", "}", ":", "\u201c", "\t", "-", "%"};
  std::uint32_t random = 1;
  for (int i = 0; i < 4'000; ++i) {
    std::string toml;
    for (int k = 0; k < 12; ++k) {
      random = random * 1664525u + 1013904223u;
      toml += pieces[(random >> 16) % std::size(pieces)];
    }
    const auto fault = fault_of(toml);
    EXPECT_TRUE(fault == "none" || fault.starts_with("rig.toml:")) << toml;
  }
}

}  // namespace
}  // namespace handcast::config
