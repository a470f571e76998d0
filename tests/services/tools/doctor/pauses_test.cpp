// SPDX-License-Identifier: Apache-2.0
#include "services/tools/doctor/pauses.hpp"

#include <gmock/gmock.h>

namespace handcast::doctor {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// Core 1 is offline.
constexpr std::string_view kInterrupts =
    "           CPU0       CPU2       \n"
    " 24:          1          7  IO-APIC   5-edge      ACPI:Ged\n"
    "125:        300      40000  IR-PCI-MSIX-0000:00:1f.6    0-edge      eno1 rx\n"
    "LOC:       1234        250   Local timer interrupts\n"
    "ERR:          3\n"
    "MIS:          0\n";

Pauses quiet() {
  return {
      .core = 2, .priority = 50, .period_us = 1057, .frames = 946, .longest_us = 40, .p99_us = 9};
}

TEST(Pauses, TheInterruptsOfACoreHaveTheNamesOfTheirDevices) {
  const auto lines = interrupts_in(kInterrupts, 2).lines;
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines.at("125").name, "eno1 rx");
  EXPECT_EQ(lines.at("125").count, 40000u);
  EXPECT_EQ(lines.at("24").name, "ACPI:Ged");
  EXPECT_EQ(lines.at("LOC").name, "Local timer interrupts");
  EXPECT_EQ(interrupts_in(kInterrupts, 0).lines.at("LOC").count, 1234u);
}

TEST(Pauses, ACoreThatIsNotThereAndATextOfNonsenseHaveNoInterrupts) {
  EXPECT_TRUE(interrupts_in(kInterrupts, 1).lines.empty());
  for (const std::string_view text : {"", "CPU2", "CPU2\n:\n24: x\n24", "\n\n"})
    EXPECT_TRUE(interrupts_in(text, 2).lines.empty()) << text;
}

TEST(Pauses, ShortOnesAreGood) {
  const auto finding = judge_pauses(quiet());
  EXPECT_EQ(finding.grade, Grade::good);
  EXPECT_THAT(finding.sentence, AllOf(HasSubstr("core 2 at priority 50"), HasSubstr("was 40 us"),
                                      HasSubstr("at most 9 us"), Not(HasSubstr("interrupts"))));
}

TEST(Pauses, LongOnesNameTheInterruptsThereAndWhatToDo) {
  auto pauses = quiet();
  pauses.longest_us = 300;
  pauses.interrupts = interrupts_in(kInterrupts, 2);
  const auto finding = judge_pauses(pauses);
  EXPECT_EQ(finding.grade, Grade::advice);
  EXPECT_THAT(
      finding.sentence,
      HasSubstr("interrupts there: eno1 rx (40000, IRQ 125), Local timer interrupts (250)"));
  EXPECT_THAT(finding.remedy, AllOf(HasSubstr("move the interrupts 125 to another core"),
                                    HasSubstr("isolcpus=2"), Not(HasSubstr("priority"))));
}

TEST(Pauses, CoreZeroCannotBeKeptFree) {
  auto pauses = quiet();
  pauses.longest_us = 300;
  pauses.core = 0;
  EXPECT_THAT(judge_pauses(pauses).remedy,
              AllOf(HasSubstr("nohz_full=N"), HasSubstr("not core 0"), Not(HasSubstr("=0"))));
}

TEST(Pauses, WithoutARealTimePriorityThatIsTheFirstStep) {
  auto pauses = quiet();
  pauses.longest_us = 4000;
  pauses.priority = 0;
  EXPECT_THAT(judge_pauses(pauses).remedy,
              testing::StartsWith("set projector.process.priority = 50"));
  EXPECT_THAT(judge_pauses(pauses).sentence, HasSubstr("at normal priority"));
  pauses.is_denied = true;
  EXPECT_THAT(judge_pauses(pauses).remedy, testing::StartsWith("permit the priority"));
}

TEST(Pauses, TheLoopRunsOnTheProjectorsCoreAndMeasures) {
  config::Rig rig;
  rig.projector.rate_hz = 500;
  rig.projector.process.cores = {0};
  const auto pauses = measure_pauses(rig);
  EXPECT_EQ(pauses.core, 0);
  EXPECT_EQ(pauses.period_us, 2000);
  EXPECT_GT(pauses.frames, 0u);
  EXPECT_LE(pauses.frames, 500u);
  EXPECT_GT(pauses.longest_us, 0);
  EXPECT_LE(pauses.p99_us, pauses.longest_us);
  EXPECT_TRUE(examine_pauses(rig, Asking::not_now).empty());
}

}  // namespace
}  // namespace handcast::doctor
