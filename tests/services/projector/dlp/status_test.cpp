// SPDX-License-Identifier: Apache-2.0
#include "services/projector/dlp/protocol/status.hpp"

#include <gmock/gmock.h>

namespace handcast::dlp::protocol {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

TEST(Status, OfAHealthyControllerHasNoFaults) {
  EXPECT_THAT(faults_of(Controller::dlpc350, {.hardware = 1, .system = 1, .main = 2}), IsEmpty());
  // Bit 4: there is a second controller. Bits 3 to 5 of the main status: the signal is locked.
  EXPECT_THAT(faults_of(Controller::dlpc900, {.hardware = 0x11, .system = 1, .main = 0x3a}),
              IsEmpty());
}

TEST(Status, EachFaultBitHasASentence) {
  EXPECT_THAT(faults_of(Controller::dlpc900, {.hardware = 0xce, .system = 0, .main = 5}),
              SizeIs(9));
  EXPECT_THAT(faults_of(Controller::dlpc350, {.hardware = 0x81, .system = 1, .main = 0}),
              ElementsAre(HasSubstr("sequencer")));
}

TEST(Status, ABitThatOneControllerDoesNotDefineMeansNothingThere) {
  EXPECT_THAT(faults_of(Controller::dlpc900, {.hardware = 3}), SizeIs(1));
  EXPECT_THAT(faults_of(Controller::dlpc350, {.hardware = 3}), IsEmpty());
}

TEST(Validation, SeparatesErrorsFromWarnings) {
  const auto bad = explain_validation(0x01);
  EXPECT_THAT(bad.errors, ElementsAre(HasSubstr("exposure")));
  EXPECT_THAT(bad.warnings, IsEmpty());
  const auto odd = explain_validation(0x1c);
  EXPECT_THAT(odd.errors, IsEmpty());
  EXPECT_THAT(odd.warnings, SizeIs(3));
  EXPECT_TRUE(is_validating(0x80));
  EXPECT_FALSE(is_validating(0x1f));
}

}  // namespace
}  // namespace handcast::dlp::protocol
