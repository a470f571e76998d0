// SPDX-License-Identifier: Apache-2.0
#include "supervisor/succession/service_unit.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "tests/scratch.hpp"
#include "tests/supervisor/life/output_of.hpp"

namespace handcast::supervisor {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

UnitSpec unit_of_desk(bool system) {
  return {.rig = "desk",
          .program = "/bin/true",
          .rig_file = "/rigs/desk.toml",
          .settings = {},
          .out = {},
          .system = system,
          .user = "daemon",
          .groups = {"video"}};
}

class EachUnit : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(ServiceUnit, EachUnit, testing::Values(false, true),
                         [](const auto& instance) { return instance.param ? "system" : "user"; });

TEST_P(EachUnit, LetsTheServicesOutliveTheirSupervisor) {
  const auto text = unit_text(unit_of_desk(GetParam()));
  EXPECT_THAT(text, AllOf(HasSubstr("\nKillMode=process\n"), HasSubstr("\nOOMPolicy=continue\n"),
                          HasSubstr("\nFileDescriptorStoreMax="),
                          HasSubstr("\nExecStop=-\"/bin/true\" down --rig desk\n")));
  // With each of these, the next supervisor could not find the living services or not take them
  // over.
  EXPECT_THAT(text, AllOf(Not(HasSubstr("\nPrivateUsers=")), Not(HasSubstr("\nPrivateTmp=")),
                          Not(HasSubstr("\nProcSubset="))));
}

TEST_P(EachUnit, WatchesAndReplacesTheSupervisorUnlessAPersonMustAct) {
  const auto text = unit_text(unit_of_desk(GetParam()));
  EXPECT_THAT(text, AllOf(HasSubstr("\nType=notify\nNotifyAccess=main\nExecStart=\"/bin/true\" up "
                                    "--no-keeper \"/rigs/desk.toml\" "),
                          HasSubstr("\nWatchdogSec="), HasSubstr("\nRestart=always\n"),
                          HasSubstr("\nRestartPreventExitStatus=0 100\n")));
}

TEST_P(EachUnit, LeavesCamerasAndRealTimeAlone) {
  const auto text = unit_text(unit_of_desk(GetParam()));
  for (const auto* closed : {"PrivateDevices=", "DeviceAllow=", "ProtectClock=", "PrivateNetwork=",
                             "RestrictRealtime=", "MemoryDenyWriteExecute="})
    EXPECT_THAT(text, Not(HasSubstr(std::string("\n") + closed)));
  EXPECT_THAT(text, AllOf(HasSubstr("\nLimitRTPRIO="), HasSubstr("\nLimitMEMLOCK=")));
}

TEST_P(EachUnit, HasNoMarkLeft) {
  EXPECT_THAT(unit_text(unit_of_desk(GetParam())),
              AllOf(Not(testing::ContainsRegex("@[A-Z_]+@")), Not(HasSubstr("#system#")),
                    Not(HasSubstr("#user#"))));
}

TEST_P(EachUnit, KeepsItsFilesInAFolderOfItsOwnOrInThatOfOut) {
  auto spec = unit_of_desk(GetParam());
  EXPECT_THAT(unit_text(spec), AllOf(HasSubstr("\nStateDirectory=handcast/desk\n"),
                                     HasSubstr(" --out \"%S/handcast/desk\"\n"),
                                     HasSubstr(" --set \"watch.folder=%S/handcast/desk/watch\" "),
                                     Not(HasSubstr("ReadWritePaths=\""))));
  spec.out = "/show/100% $kept";
  const auto text = unit_text(spec);
  EXPECT_THAT(text, HasSubstr(R"( --out "/show/100%% $$kept")"));
  const auto writable = HasSubstr("\nReadWritePaths=\"-/show/100%% $kept\"\n");
  if (GetParam())
    EXPECT_THAT(text, writable);
  else
    EXPECT_THAT(text, Not(HasSubstr("ReadWritePaths")));
}

TEST_P(EachUnit, StopsWhatIsLeftAfterAStopThatTookTooLongAndNothingAfterACrash) {
  EXPECT_THAT(unit_text(unit_of_desk(GetParam())),
              HasSubstr("\nExecStopPost=-/bin/sh -c '[ \"$$SERVICE_RESULT\" != timeout ] || exec "
                        "\"$$@\"' sh \"/bin/true\" down --rig desk\n"));
}

/// What `systemd-analyze ARGUMENTS FILE` says about a unit, and its exit code.
std::string analyzed(const std::string& arguments, const UnitSpec& spec) {
  const test::Scratch scratch;
  const auto file = scratch.path() / unit_name(spec);
  std::ofstream(file) << unit_text(spec);
  return test::output_of(
      "/bin/bash", {"-c", "systemd-analyze " + arguments + " " + file.string() + "; echo exit $?"});
}

bool can_analyze() { return std::filesystem::exists("/usr/bin/systemd-analyze"); }

TEST_P(EachUnit, WithAWindowBelongsToAGraphicalSession) {
  auto spec = unit_of_desk(GetParam());
  EXPECT_THAT(unit_text(spec), Not(HasSubstr("graphical")));
  spec.window = true;
  spec.display = ":7";
  spec.x_authority = "/home/100%/.Xauthority";
  const auto text = unit_text(spec);
  if (GetParam())
    EXPECT_THAT(text, AllOf(HasSubstr("\nEnvironment=\"DISPLAY=:7\" "
                                      "\"XAUTHORITY=/home/100%%/.Xauthority\"\n"),
                            HasSubstr("\nWantedBy=graphical.target\n")));
  else
    EXPECT_THAT(text, AllOf(HasSubstr("\nAfter=graphical-session.target\n"),
                            HasSubstr("\nPartOf=graphical-session.target\n"),
                            HasSubstr("\nWantedBy=graphical-session.target\n"),
                            HasSubstr("show-environment"), Not(HasSubstr("DISPLAY="))));
}

TEST_P(EachUnit, HasTheRightToRealTimeIfAServiceWantsIt) {
  auto spec = unit_of_desk(GetParam());
  EXPECT_THAT(unit_text(spec), Not(HasSubstr("CAP_SYS_NICE")));
  spec.real_time = true;
  const auto wanted = AllOf(HasSubstr("\nAmbientCapabilities=CAP_SYS_NICE\n"),
                            HasSubstr("\nCapabilityBoundingSet=CAP_SYS_NICE\n"));
  if (GetParam())
    EXPECT_THAT(unit_text(spec), wanted);
  else
    EXPECT_THAT(unit_text(spec), Not(wanted));
}

TEST_P(EachUnit, IsAcceptedBySystemd) {
  if (!can_analyze()) GTEST_SKIP() << "systemd-analyze is not installed";
  auto spec = unit_of_desk(GetParam());
  spec.window = spec.real_time = true;
  spec.display = ":0";
  spec.x_authority = "/home/a user/.Xauthority";
  for (const char* out : {"", "/show/100% \"$kept\""}) {
    spec.out = out;
    EXPECT_THAT(analyzed("verify --man=no --recursive-errors=no", spec),
                AllOf(HasSubstr("exit 0"),
                      Not(HasSubstr("desk.service"))));  // a complaint names the unit
  }
}

TEST(ServiceUnit, OfThePackageRunsTheRigOfItsInstanceWhateverTheFileCallsIt) {
  const auto spec = template_spec("/usr/bin/handcast");
  EXPECT_EQ(unit_name(spec), "handcast@.service");
  EXPECT_THAT(
      unit_text(spec),
      AllOf(HasSubstr("\nExecStart=\"/usr/bin/handcast\" up --no-keeper "
                      "\"/etc/handcast/%i.toml\" --out \"%L/handcast/%i\" --set \"name=%i\" "),
            HasSubstr("\nExecStop=-\"/usr/bin/handcast\" down --rig %i\n"),
            HasSubstr("\nUser=handcast\n"), Not(testing::ContainsRegex("@[A-Z_]+@")),
            Not(HasSubstr("#template#"))));
}

TEST(ServiceUnit, OfThePackageIsTheSameOnEachMachineAndMayDoWhatDevicesNeed) {
  EXPECT_THAT(unit_text(template_spec("/usr/bin/handcast")),
              AllOf(HasSubstr("\nSupplementaryGroups=video render input plugdev\n"),
                    HasSubstr("\nAmbientCapabilities=CAP_SYS_NICE\n"),
                    HasSubstr("\nReadWritePaths=\"-/etc/handcast\"\n")));
}

TEST(ServiceUnit, OfTheMachineHasAFolderForTheAddressOfTheDesk) {
  EXPECT_THAT(unit_text(unit_of_desk(true)),
              AllOf(HasSubstr("\nRuntimeDirectory=handcast/desk\nRuntimeDirectoryMode=0700\n"),
                    HasSubstr("\nRuntimeDirectoryPreserve=restart\n")));
  EXPECT_THAT(unit_text(unit_of_desk(false)), Not(HasSubstr("RuntimeDirectory")));
}

TEST(ServiceUnit, OfTheMachineIsAtMostThreeOfTenExposed) {
  if (!can_analyze()) GTEST_SKIP() << "systemd-analyze is not installed";
  EXPECT_THAT(analyzed("security --offline=true --threshold=30 --no-pager", unit_of_desk(true)),
              HasSubstr("exit 0"));
}

TEST(ServiceUnit, OfTheMachineIsShutInAndHasAUser) {
  const auto text = unit_text(unit_of_desk(true));
  EXPECT_THAT(text,
              AllOf(HasSubstr("\nProtectSystem=strict\n"), HasSubstr("\nUser=daemon\n"),
                    HasSubstr("\nSupplementaryGroups=video\n"), HasSubstr("\nOOMScoreAdjust=-"),
                    HasSubstr("\nWantedBy=multi-user.target\n"), Not(HasSubstr("default.target"))));
  EXPECT_EQ(unit_folder(unit_of_desk(true)), "/etc/systemd/system");
}

TEST(ServiceUnit, OfAUserAsksForNothingAUserCannotHave) {
  const auto text = unit_text(unit_of_desk(false));
  EXPECT_THAT(text,
              AllOf(Not(HasSubstr("\nProtectSystem=")), Not(HasSubstr("\nUser=")),
                    Not(HasSubstr("\nSupplementaryGroups=")), Not(HasSubstr("\nOOMScoreAdjust=")),
                    HasSubstr("\nWantedBy=default.target\n")));
}

TEST(ServiceUnit, PathsAndSettingsReachTheCommandAsTheyAre) {
  auto spec = unit_of_desk(false);
  spec.rig_file = "/my rigs/100% $HOME/a\"b\\c.toml";
  spec.settings = {"name=\"sofa\""};
  EXPECT_THAT(unit_text(spec),
              AllOf(HasSubstr(R"(up --no-keeper "/my rigs/100%% $$HOME/a\"b\\c.toml" )"),
                    HasSubstr(R"(--out "%S/handcast/desk" --set "name=\"sofa\"")")));
}

}  // namespace
}  // namespace handcast::supervisor
