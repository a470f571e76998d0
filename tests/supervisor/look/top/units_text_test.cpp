// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/top/units_text.hpp"

#include <gtest/gtest.h>

namespace handcast::supervisor {
namespace {

TEST(UnitsText, SpansHaveThreeDigitsAndAUnitAPersonKnows) {
  EXPECT_EQ(text_of_span(0), "0 ns");
  EXPECT_EQ(text_of_span(850), "850 ns");
  EXPECT_EQ(text_of_span(1'249'000), "1.25 ms");
  EXPECT_EQ(text_of_span(999'700'000), "1 s");
  EXPECT_EQ(text_of_span(12'340'000'000), "12.3 s");
  EXPECT_EQ(text_of_span(125'000'000'000), "2 min 5 s");
  EXPECT_EQ(text_of_span(3 * 3600'000'000'000), "3 h");
  EXPECT_EQ(text_of_span((4 * 24 + 2) * 3600'000'000'000), "4 d 2 h");
  EXPECT_EQ(text_of_span(-2'000'000), "-2 ms");
}

TEST(UnitsText, BytesRatesSharesAndCountsToo) {
  EXPECT_EQ(text_of_bytes(512), "512 B");
  EXPECT_EQ(text_of_bytes(1010 * 1024), "1010 KiB");
  EXPECT_EQ(text_of_bytes(38 << 20), "38 MiB");
  EXPECT_EQ(text_of_bytes(std::int64_t{3} << 29), "1.5 GiB");
  EXPECT_EQ(text_of_rate(239.96), "240 Hz");
  EXPECT_EQ(text_of_rate(0.5), "0.5 Hz");
  EXPECT_EQ(text_of_rate(1234), "1.23 kHz");
  EXPECT_EQ(text_of_share(0.0312), "3.1 %");
  EXPECT_EQ(text_of_share(1.17), "117 %");
  EXPECT_EQ(text_of_count(0), "0");
  EXPECT_EQ(text_of_count(999), "999");
  EXPECT_EQ(text_of_count(12'345'678), "12 345 678");
}

TEST(UnitsText, TextIsCutBetweenCharactersNeverWithin) {
  EXPECT_EQ(columns_of("Grüße"), 5u);
  EXPECT_EQ(cut_to("Grüße", 5), "Grüße");
  EXPECT_EQ(cut_to("Grüße", 4), "Grü…");
  EXPECT_EQ(cut_to("Grüße", 1), "…");
  EXPECT_EQ(cut_to("Grüße", 0), "");
}

TEST(UnitsText, WhatAServiceSaysCannotMoveTheCursor) {
  EXPECT_EQ(harmless("a\x1b[2Jb\tc\x7f"), "a?[2Jb?c?");
  EXPECT_EQ(harmless("\xc2\x9bm"), "?m");  // one of the second set of control characters
  EXPECT_EQ(harmless("Grüße"), "Grüße");
}

}  // namespace
}  // namespace handcast::supervisor
