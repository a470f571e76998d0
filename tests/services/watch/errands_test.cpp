// SPDX-License-Identifier: Apache-2.0
#include "services/watch/errands.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>

#include <chrono>
#include <fstream>
#include <sstream>

#include "ipc/base/clock.hpp"
#include "tests/scratch.hpp"

namespace handcast::watch {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class ErrandsTest : public testing::Test {
 protected:
  Errands errands(double longest_s = 60) {
    return Errands({longest_s, folder_.path(),
                    [this](const std::string& failure) { failures_.push_back(failure); }});
  }
  static void finish(Errands& errands) {
    for (const auto limit = Deadline::in(60s); !errands.is_done() && !limit.passed();) {
      errands.turn(now_ns());
      sleep_until_ns(now_ns() + to_ns(1ms));
    }
    EXPECT_TRUE(errands.is_done());
  }
  static std::vector<std::string> shell(const std::string& script) { return {"sh", "-c", script}; }
  std::string text_of(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(folder_.path() / name).rdbuf();
    return text.str();
  }
  const ::handcast::test::Scratch folder_;
  std::vector<std::string> failures_;
};

TEST_F(ErrandsTest, AProgramGetsItsTextAndRunsInItsFolder) {
  auto all = errands();
  const std::string text(200'000, 'x');  // more than a pipe holds
  all.add(shell("cat >text"), text);
  finish(all);
  EXPECT_EQ(text_of("text"), text);
  EXPECT_THAT(failures_, IsEmpty());
}

TEST_F(ErrandsTest, OneComesAfterTheOther) {
  auto all = errands();
  all.add(shell("sleep 0.2; echo one >>order"), "");
  all.add(shell("echo two >>order"), "");
  all.add({}, "no program is no errand");
  finish(all);
  EXPECT_EQ(text_of("order"), "one\ntwo\n");
}

TEST_F(ErrandsTest, AFailureIsNamedWithWhatWasPrinted) {
  auto all = errands();
  all.add(shell("echo no such host >&2; exit 3"), "");
  all.add({"no_such_program"}, "");
  finish(all);
  EXPECT_THAT(failures_, ElementsAre(HasSubstr("'sh' ended with exit 3: no such host"),
                                     AllOf(HasSubstr("'no_such_program' cannot be started"),
                                           HasSubstr("No such file"))));
}

TEST_F(ErrandsTest, OneThatHangsIsKilledWithWhatItStartedAndTheNextOneRuns) {
  auto all = errands(0.3);
  all.add(shell("trap '' TERM; sleep 1000 & echo $! >pid; wait"), "");
  all.add(shell("echo next >next"), "");
  finish(all);
  EXPECT_THAT(failures_, ElementsAre(HasSubstr("longer than 0.3 s")));
  EXPECT_EQ(text_of("next"), "next\n");
  const auto pid = static_cast<pid_t>(std::stoi(text_of("pid")));
  const auto limit = Deadline::in(60s);
  while (::kill(pid, 0) == 0 && !limit.passed()) sleep_until_ns(now_ns() + to_ns(1ms));
  EXPECT_NE(::kill(pid, 0), 0);
}

TEST_F(ErrandsTest, ATurnDoesNotWait) {
  auto all = errands();
  all.add(shell("sleep 1000"), "");
  for (int i = 0; i < 100; ++i) all.turn(now_ns());
  EXPECT_FALSE(all.is_done());  // a turn that waited would not have come to here
}

TEST_F(ErrandsTest, OneThatPrintsWithoutEndIsKilledAsWell) {
  auto all = errands(0.3);
  all.add({"yes"}, "");
  finish(all);
  EXPECT_THAT(failures_, ElementsAre(HasSubstr("longer than")));
}

TEST_F(ErrandsTest, ItHasNoDescriptorsOfTheRig) {
  auto all = errands();
  const UniqueFd ring(::open(folder_.path().c_str(), O_RDONLY | O_DIRECTORY));  // inheritable
  all.add(shell("for i in 3 4 5 6 7 8 9 10 11 12; do [ -e /proc/$$/fd/$i ] && exit 1; done; :"),
          "");
  finish(all);
  EXPECT_THAT(failures_, IsEmpty());
}

TEST_F(ErrandsTest, OfTooManyTheOldestAreLeftOut) {
  auto all = errands();
  for (int i = 0; i < 100; ++i) all.add(shell("echo " + std::to_string(i) + " >>order"), "");
  finish(all);
  EXPECT_THAT(text_of("order"), AllOf(HasSubstr("99\n"), Not(HasSubstr("50\n"))));
}

}  // namespace
}  // namespace handcast::watch
