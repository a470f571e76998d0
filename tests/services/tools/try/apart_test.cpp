// SPDX-License-Identifier: Apache-2.0
#include "services/tools/try/apart.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <array>
#include <csignal>

#include "services/tools/try/verdict.hpp"

namespace handcast::trial {
namespace {

using testing::HasSubstr;
using Tell = std::function<void(const Report&)>;

Report after_three() {
  auto report = blank_report("some");
  report["loaded"] = true;
  report["pictures"] = 3;
  return report;
}

TEST(DrawApart, WhatTheOtherProcessHasFoundOutArrives) {
  const auto report = draw_apart({.source = "some"}, [](const Wanted&, const Tell& tell) {
    auto found = after_three();
    tell(found);
    found["drawn"] = true;
    found["parameters"].push_back(std::string(300'000, 'x'));  // more than a pipe holds
    tell(found);
    return found;
  });
  EXPECT_EQ(report["drawn"], true);
  EXPECT_EQ(report["parameters"][0].get<std::string>().size(), 300'000u);
  EXPECT_EQ(report["end"], "");
}

TEST(DrawApart, ACrashIsReportedWithWhatWasThereBefore) {
  const auto report = draw_apart({.source = "some"}, [](const Wanted&, const Tell& tell) {
    tell(after_three());
    std::signal(SIGABRT, SIG_DFL);
    std::raise(SIGABRT);
    return Report();
  });
  EXPECT_EQ(report["end"], "crash");
  EXPECT_EQ(report["drawn"], false);
  EXPECT_EQ(report["pictures"], 3);
  EXPECT_THAT(verdict(report),
              HasSubstr("some: not drawn: it crashes (Aborted) (3 pictures before)"));
}

TEST(DrawApart, AnEndOfTheProcessIsACrash) {
  const auto report =
      draw_apart({.source = "some"}, [](const Wanted&, const Tell&) -> Report { _exit(7); });
  EXPECT_EQ(report["end"], "crash");
  EXPECT_EQ(report["source"], "some");
}

TEST(DrawApart, AHangIsEndedAndReported) {
  const auto report =
      draw_apart({.source = "some", .patience_s = 0.3}, [](const Wanted&, const Tell& tell) {
        tell(after_three());
        for (;;) pause();
        return Report();
      });
  EXPECT_EQ(report["end"], "hang");
  EXPECT_EQ(report["pictures"], 3);
  EXPECT_THAT(verdict(report), HasSubstr("no step has ended within 0.3 s"));
}

TEST(Verdict, TheSummaryCountsWhatIsSaid) {
  std::array<Report, 4> reports;
  reports.fill(after_three());
  for (auto& each : reports) each["drawn"] = each["plain"] = true;
  reports[0]["motion"] = "moves";
  reports[1]["motion"] = "reacts";
  reports[1]["reacts_to"] = {"speed", "tint"};
  reports[2]["motion"] = "still";
  reports[2]["plain"] = false;
  reports[3] = blank_report("gone");
  reports[3]["error"] = "no such file";
  EXPECT_EQ(
      summary(reports),
      "3 of 4 loaded, 3 drawn: 1 move, 1 react to parameters, 1 are still, 2 are of one colour; "
      "0 hang, 0 crash");
  EXPECT_THAT(verdict(reports[1]), HasSubstr("still, reacts to speed, tint, of one colour"));
  EXPECT_EQ(verdict(reports[3]), "gone: not loaded: no such file");
}

}  // namespace
}  // namespace handcast::trial
