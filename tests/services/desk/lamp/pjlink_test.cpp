// SPDX-License-Identifier: Apache-2.0
#include "services/desk/lamp/pjlink.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <cstdlib>
#include <fstream>

#include "services/tools/doctor/lamp.hpp"
#include "tests/scratch.hpp"
#include "tests/services/desk/lamp/pjlink_projector.hpp"

namespace handcast::desk::lamp {
namespace {

using namespace std::chrono_literals;
using config::Lamp;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class Pjlink : public testing::Test {
 protected:
  Result<bool> tell_it(Lamp wanted, const std::string& input = "") {
    return tell(projector.place, wanted, input, Deadline::in(5s));
  }
  /// The sentence of a status that is asked for for 300 ms.
  Error fault() {
    const auto status = ask(projector.place, Deadline::in(300ms));
    return status ? Error{Errc::timeout, "none"} : status.error();
  }
  test::PjlinkProjector projector;
};

TEST(Md5, IsThatOfTheStandard) {
  EXPECT_EQ(md5(""), "d41d8cd98f00b204e9800998ecf8427e");
  EXPECT_EQ(md5("abc"), "900150983cd24fb0d6963f7d28e17f72");
  EXPECT_EQ(md5("12345678901234567890123456789012345678901234567890123456789012345678901234567890"),
            "57edf4a22be3c955ac49da2e2107b67a");
}

TEST_F(Pjlink, ALampIsTurnedOnAndItsPictureIsShown) {
  projector.set("AVMT", "31");
  EXPECT_EQ(*tell_it(Lamp::on, "31"), false) << "it warms up";
  EXPECT_EQ(projector.state("POWR"), "1");
  EXPECT_EQ(*tell_it(Lamp::on, "31"), true);
  EXPECT_EQ(projector.state("AVMT"), "30");
  EXPECT_EQ(projector.state("INPT"), "31");
  const auto before = static_cast<std::ptrdiff_t>(projector.commands().size());
  EXPECT_EQ(*tell_it(Lamp::on, "31"), true);
  const auto commands = projector.commands();
  EXPECT_THAT(std::vector(commands.begin() + before, commands.end()),
              ElementsAre("%1POWR ?", "%1AVMT ?", "%1INPT ?"))
      << "what is so already is not told again";
}

TEST_F(Pjlink, MuteClosesTheShutterAndOffTurnsItOff) {
  projector.set("POWR", "1");
  EXPECT_EQ(*tell_it(Lamp::mute), true);
  EXPECT_EQ(projector.state("AVMT"), "31");
  EXPECT_EQ(*tell_it(Lamp::off), true);
  EXPECT_EQ(projector.state("POWR"), "0");
  EXPECT_EQ(*tell_it(Lamp::unchanged), true);
  projector.set("POWR", "3");
  EXPECT_EQ(*tell_it(Lamp::mute), false) << "it warms up";
  projector.answer("POWR", "%1POWR=ERR3\r");
  EXPECT_EQ(tell_it(Lamp::on).error().code, Errc::unavailable);
}

TEST_F(Pjlink, TheStatusIsThatOfTheProjector) {
  projector.set("POWR", "1");
  projector.set("AVMT", "31");
  projector.set("LAMP", "1234 1 567 0");
  projector.set("ERST", "200010");
  const auto status = ask(projector.place, Deadline::in(5s));
  ASSERT_TRUE(status) << status.error().what;
  EXPECT_EQ(status->name, "Theatre left");
  EXPECT_EQ(words_for(status->power), "on");
  EXPECT_TRUE(status->is_muted);
  EXPECT_EQ(status->input, "11");
  ASSERT_EQ(status->lamps.size(), 2u);
  EXPECT_EQ(status->lamps[0].hours, 1234);
  EXPECT_TRUE(status->lamps[0].is_on);
  EXPECT_EQ(status->lamps[1].hours, 567);
  EXPECT_THAT(status->faults, ElementsAre("fan: error", "filter: warning"));
}

TEST_F(Pjlink, InStandbyAProjectorMayRefuseToSayMore) {
  for (const auto* command : {"AVMT", "INPT", "ERST"})
    projector.answer(command, std::string("%1") + command + "=ERR3\r");
  projector.answer("LAMP", "%1LAMP=ERR1\r");
  const auto status = ask(projector.place, Deadline::in(5s));
  ASSERT_TRUE(status) << status.error().what;
  EXPECT_EQ(status->power, Status::Power::off);
  EXPECT_EQ(status->input, "");
  EXPECT_TRUE(status->lamps.empty());
}

TEST_F(Pjlink, ThePasswordIsMixedWithTheGreeting) {
  projector.lock("JBMIAProjectorLink");
  EXPECT_THAT(fault().what, HasSubstr("asks for a password"));
  projector.place.password = "wrong";
  EXPECT_EQ(fault().code, Errc::bad_config);
  EXPECT_THAT(fault().what, AllOf(HasSubstr("refuses the password"), Not(HasSubstr("wrong"))));
  projector.place.password = "JBMIAProjectorLink";
  EXPECT_TRUE(ask(projector.place, Deadline::in(5s)));
  projector.greet("PJLINK ERRA\r");
  EXPECT_THAT(fault().what, HasSubstr("refuses the password"));
}

TEST_F(Pjlink, WhatItRefusesIsSaid) {
  projector.set("POWR", "1");
  projector.answer("INPT", "%1INPT=ERR2\r");
  EXPECT_THAT(tell_it(Lamp::on, "99").error().what, HasSubstr("check projector.lamp.input"));
  projector.answer("POWR", "%1POWR=ERR4\r");
  EXPECT_THAT(tell_it(Lamp::on).error().what, HasSubstr("reports a fault"));
  projector.answer("POWR", "%1POWR=ERR1\r");
  EXPECT_THAT(tell_it(Lamp::on).error().what, HasSubstr("has no command POWR ?"));
}

TEST_F(Pjlink, WhatDoesNotSpeakPjlinkEndsInASentence) {
  projector.greet("SSH-2.0-OpenSSH_9.2\r");
  EXPECT_THAT(fault().what, HasSubstr("does not speak PJLink: it says 'SSH-2.0-OpenSSH_9.2'"));
  projector.greet("PJLINK 1 \r");
  EXPECT_EQ(fault().code, Errc::bad_data);
  projector.greet(std::string(2000, 'x'));
  EXPECT_THAT(fault().what, HasSubstr("its line does not end"));
  projector.greet("");
  EXPECT_EQ(fault().code, Errc::timeout);
  EXPECT_THAT(fault().what, HasSubstr("did not answer in time"));
  projector.greet("close");
  EXPECT_EQ(fault().code, Errc::disconnected);
  projector.greet("PJLINK 0\r");
  projector.answer("POWR", "%1POWR=9\r");
  EXPECT_EQ(fault().code, Errc::bad_data);
  projector.answer("POWR", std::string("\xff\0\x01=\r", 5));
  EXPECT_EQ(fault().code, Errc::bad_data);
  projector.answer("POWR", "close");
  EXPECT_EQ(fault().code, Errc::disconnected);
  projector.answer("POWR", "%1POWR=1");
  EXPECT_EQ(fault().code, Errc::timeout) << "half a line";
}

TEST_F(Pjlink, NobodyAtThePlaceIsSaidAtOnce) {
  projector.place.port = "1";
  EXPECT_EQ(fault().code, Errc::unavailable);
  EXPECT_THAT(fault().what, HasSubstr("is it on the network"));
}

TEST_F(Pjlink, AStopEndsTheWait) {
  projector.greet("");
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(ask(projector.place, Deadline::in(3600s), stop.get_token()));
}

TEST(PjlinkPlace, IsAHostAndMayHaveAPort) {
  const auto of = [](const std::string& text) { return place_of({text, "", ""}); };
  EXPECT_EQ(of("10.0.0.5")->port, "4352");
  EXPECT_EQ(of("projector:99")->host, "projector");
  EXPECT_EQ(of("projector:99")->port, "99");
  EXPECT_EQ(of("[::1]:99")->host, "::1");
  EXPECT_EQ(of("::1")->host, "::1");
  EXPECT_EQ(of("[::1]")->port, "4352");
  for (const auto* wrong : {"", ":4352", "a:", "a:x"}) EXPECT_FALSE(of(wrong)) << wrong;
}

TEST(PjlinkPlace, ThePasswordIsInAFileOfThisUserOrInTheEnvironment) {
  test::Scratch scratch;
  const std::string file = scratch.path() / "password";
  std::ofstream(file) << "secret\nmore\n";
  ::chmod(file.c_str(), 0644);
  EXPECT_THAT(place_of({"a", file, ""}).error().what,
              AllOf(HasSubstr("chmod 600"), Not(HasSubstr("secret"))));
  ::chmod(file.c_str(), 0600);
  EXPECT_EQ(place_of({"a", file, ""})->password, "secret");
  EXPECT_FALSE(place_of({"a", "/no/such/file", ""}));
  std::ofstream(file) << std::string(33, 'x');
  EXPECT_THAT(place_of({"a", file, ""}).error().what, HasSubstr("32 characters"));
  ::setenv("HANDCAST_PJLINK_PASSWORD", "from outside", 1);
  EXPECT_EQ(place_of({"a", "", ""})->password, "from outside");
  ::unsetenv("HANDCAST_PJLINK_PASSWORD");
  EXPECT_EQ(place_of({"a", "", ""})->password, "");
}

TEST_F(Pjlink, TheDoctorAsksTheLamp) {
  config::Rig rig;
  EXPECT_TRUE(doctor::examine_lamp(rig).empty());
  rig.projector.lamp.pjlink = "127.0.0.1:" + projector.place.port;
  const auto grade = [&] { return doctor::examine_lamp(rig).at(0).grade; };
  EXPECT_EQ(grade(), doctor::Grade::advice) << "it is off";
  projector.set("POWR", "1");
  EXPECT_EQ(grade(), doctor::Grade::good);
  projector.set("ERST", "010000");
  EXPECT_EQ(grade(), doctor::Grade::fault);
  EXPECT_THAT(doctor::examine_lamp(rig)[0].sentence, HasSubstr("lamp: warning"));
  projector.greet("close");
  EXPECT_EQ(grade(), doctor::Grade::fault);
}

}  // namespace
}  // namespace handcast::desk::lamp
