// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/quote.hpp"

#include <gtest/gtest.h>

#include "ipc/base/log.hpp"

namespace handcast {
namespace {

TEST(Quote, ShowsAShortTextAsItIs) {
  EXPECT_EQ(quote("rate_hz"), "'rate_hz'");
  EXPECT_EQ(quote("Hände/é.png"), "'Hände/é.png'");
  EXPECT_EQ(quote(""), "''");
}

TEST(Quote, StaysOnOneLineAndMovesNoCursor) {
  EXPECT_EQ(quote("a\nb\r\tc"), "'a\\nb\\r\\tc'");
  EXPECT_EQ(quote("\x1b[2J\x7f"), "'\\x1b[2J\\x7f'");
  EXPECT_EQ(quote("a\xc2\x9b"
                  "2Jb"),
            "'a\\xc2\\x9b2Jb'")
      << "the one-byte form of ESC [";
  EXPECT_EQ(quote({"a\0b", 3}), "'a\\x00b'");
}

TEST(Quote, ShowsBytesThatAreNotUtf8AsNumbers) {
  EXPECT_EQ(quote("caf\xe9"), "'caf\\xe9'");
  EXPECT_EQ(quote("\xe2\x82"), "'\\xe2\\x82'") << "cut off";
  EXPECT_EQ(quote("\xff"), "'\\xff'");
}

TEST(Quote, KeepsTheEndsOfALongText) {
  const auto shown = quote("begin" + std::string(838'000, 'A') + "end");
  EXPECT_LT(shown.size(), 120u);
  EXPECT_TRUE(shown.starts_with("'beginAAA")) << shown;
  EXPECT_TRUE(shown.ends_with("AAAend' (838008 bytes)")) << shown;
}

TEST(Quote, CutsBetweenCharacters) {
  std::string text;
  for (int i = 0; i < 100; ++i) text += "ä";
  for (std::size_t most = 20; most < 24; ++most)
    EXPECT_EQ(quote(text, most).find("\\x"), std::string::npos) << quote(text, most);
}

TEST(Printable, KeepsLinesAndCutsThoseThatNobodyReads) {
  const auto shown = printable("one\n" + std::string(838'000, 'A') + "\nthree\n");
  EXPECT_LT(shown.size(), 2200u);
  EXPECT_TRUE(shown.starts_with("one\nAAAA")) << shown;
  EXPECT_NE(shown.find("(838000 bytes)"), std::string::npos);
  EXPECT_TRUE(shown.ends_with("AAAA\nthree\n"));
  EXPECT_EQ(printable("a\xc2\x9b"
                      "b\xe9"),
            "a\\xc2\\x9bb\xe9");
}

}  // namespace
}  // namespace handcast
