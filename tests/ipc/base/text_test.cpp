// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/text.hpp"

#include <gtest/gtest.h>

namespace handcast {
namespace {

TEST(Text, WhatIsTrimmedHasNoBlanksAtItsEnds) {
  for (const auto* text : {"a b", " a b", "a b\r\n", "\t a b \n\n"})
    EXPECT_EQ(trimmed(text), "a b");
  for (const auto* text : {"", " ", " \t\r\n"}) EXPECT_EQ(trimmed(text), "");
}

TEST(Text, InHtmlNothingFromOutsideIsMarkup) {
  EXPECT_EQ(html_of("<b title=\"x\">R&D</b>"), "&#60;b title=&#34;x&#34;&#62;R&#38;D&#60;/b&#62;");
  EXPECT_EQ(html_of("é\n\x1b"), "é\n\\x1b");
}

}  // namespace
}  // namespace handcast
