// SPDX-License-Identifier: Apache-2.0
#include "ipc/control/control_message.hpp"

#include <gmock/gmock.h>

namespace handcast::control {
namespace {

using testing::HasSubstr;

TEST(ControlMessage, ARequestComesBackAsItWasSent) {
  const auto request = parse_request(print_request({Verb::swap, "pose", "replay"}));
  ASSERT_TRUE(request);
  EXPECT_EQ(request->verb, Verb::swap);
  EXPECT_EQ(request->service, "pose");
  EXPECT_EQ(request->backend, "replay");
}

TEST(ControlMessage, NonsenseIsRefusedWithASentence) {
  for (const auto* line : {"", "[]", "{", "42", R"({"verb":7})", R"({"verb":"fly"})",
                           R"({"verb":"swap","service":"pose"})", R"({"verb":"restart"})"}) {
    const auto request = parse_request(line);
    ASSERT_FALSE(request) << line;
    EXPECT_EQ(request.error().code, Errc::bad_data);
    EXPECT_FALSE(request.error().what.empty());
  }
}

TEST(ControlMessage, ARequestForThePastSaysHowMuchOfIt) {
  EXPECT_EQ(
      parse_request(
          print_request({.verb = Verb::history, .service = {}, .backend = {}, .seconds = 2.5}))
          ->seconds,
      2.5);
  for (const auto* line :
       {R"({"verb":"history"})", R"({"verb":"history","seconds":0})",
        R"({"verb":"history","seconds":-1})", R"({"verb":"history","seconds":"10"})",
        R"({"verb":"history","seconds":null})"}) {
    const auto request = parse_request(line);
    ASSERT_FALSE(request) << line;
    EXPECT_THAT(request.error().what, HasSubstr("a number above 0"));
  }
}

TEST(ControlMessage, EveryVerbHasItsName) {
  for (const auto verb : {Verb::status, Verb::down, Verb::reload, Verb::rings, Verb::rig})
    EXPECT_EQ(parse_request(print_request({.verb = verb}))->verb, verb);
}

TEST(ControlMessage, WhatAPersonTypedMayBeAnyBytes) {
  EXPECT_TRUE(parse_request(print_request({Verb::restart, "pose\xff", ""})));
}

}  // namespace
}  // namespace handcast::control
