// SPDX-License-Identifier: Apache-2.0
#include "renderer/output/edid.hpp"

#include <gtest/gtest.h>

#include "tests/renderer/output/edid_block.hpp"

namespace handcast::renderer {
namespace {

using test::edid_with;

TEST(ModelOf, IsTheNameInTheEdid) { EXPECT_EQ(model_of(edid_with("EPSON PJ\n    ")), "EPSON PJ"); }

TEST(ModelOf, MayFillTheDescriptor) {
  EXPECT_EQ(model_of(edid_with("THIRTEEN LONG")), "THIRTEEN LONG");
}

TEST(ModelOf, OfADamagedBlockIsEmpty) {
  auto edid = edid_with("EPSON PJ\n");
  EXPECT_EQ(model_of(std::span(edid).first(100)), "");
  EXPECT_EQ(model_of({}), "");
  edid[60] ^= 1;  // the checksum is wrong
  EXPECT_EQ(model_of(edid), "");
}

TEST(ModelOf, HasNoControlCharacters) { EXPECT_EQ(model_of(edid_with("A\x1b[2JB\n")), "A[2JB"); }

}  // namespace
}  // namespace handcast::renderer
