// SPDX-License-Identifier: Apache-2.0
// The main function of tests with emulated USB devices.
#include <gtest/gtest.h>

#include "tests/emulation/under_umockdev.hpp"

int main(int argc, char** argv) {
#ifndef HANDCAST_WITH_SANITIZER
  handcast::test::see_emulated_devices(argv);
#endif
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
