// SPDX-License-Identifier: Apache-2.0
#include "services/desk/osc/packet.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/desk/osc/pattern.hpp"
#include "tests/services/desk/osc/packets.hpp"

namespace handcast::desk::osc {
namespace {

using test::bytes_of;
using test::packet;
using testing::HasSubstr;
using namespace std::string_literals;

std::string fault_of(const std::string& bytes) {
  const auto message = read_message(bytes_of(bytes));
  return message ? "" : message.error().what;
}

TEST(OscPacket, AMessageIsReadAsItWasWritten) {
  const auto bytes = packet("/a/b", 0.25f, std::int32_t{-3}, "left", true, false);
  const auto message = read_message(bytes_of(bytes));
  ASSERT_TRUE(message) << message.error().what;
  EXPECT_EQ(message->address, "/a/b");
  ASSERT_EQ(message->count, 5u);
  EXPECT_EQ(message->all[0].number, 0.25);
  EXPECT_EQ(message->all[1].number, -3);
  EXPECT_EQ(message->all[2].text, "left");
  EXPECT_EQ(message->all[3].number, 1);
  EXPECT_EQ(message->all[4].number, 0);
}

TEST(OscPacket, TheBytesAreThoseOfTheSpecification) {
  EXPECT_EQ(packet("/oscillator/4/frequency", 440.f),
            "/oscillator/4/frequency\0,f\0\0\x43\xdc\0\0"s);
}

TEST(OscPacket, WideTypesAndListsAreRead) {
  const auto bytes =
      "/a\0\0,[hd]tcSN\0\0\0\0\0\0\0\0\0\0\x07\x3f\xe0\0\0\0\0\0\0"
      "\0\0\0\0\0\0\0\1\0\0\0A"
      "word\0\0\0\0"s;
  const auto message = read_message(bytes_of(bytes));
  ASSERT_TRUE(message) << message.error().what;
  ASSERT_EQ(message->count, 6u);
  EXPECT_EQ(message->all[0].number, 7);
  EXPECT_EQ(message->all[1].number, 0.5);
  EXPECT_EQ(message->all[4].text, "word");
  EXPECT_EQ(message->all[5].type, 'N');
}

TEST(OscPacket, ABlobIsSkippedAndOneOfAnImpossibleLengthIsRefused) {
  EXPECT_EQ(fault_of("/a\0\0,bi\0\0\0\0\x03"
                     "abc\0\0\0\0\1"s),
            "");
  for (const auto& length : {"\xff\xff\xff\xff"s, "\x7f\xff\xff\xff"s, "\0\0\0\x09"s})
    EXPECT_THAT(fault_of("/a\0\0,b\0\0"s + length + "abcdefgh"), HasSubstr("ends within"));
}

TEST(OscPacket, EveryCutOfAMessageIsRefused) {
  const auto whole = packet("/projector/brightness", 0.5f, "text");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    // A message that ends behind its address has no arguments: that is allowed.
    const auto message = read_message(bytes_of(whole).first(size));
    EXPECT_EQ(message.has_value(), size == 24) << size;
  }
  EXPECT_THAT(fault_of(whole + "\0\0\0\0"s), HasSubstr("behind its arguments"));
}

TEST(OscPacket, TextThatDoesNotEndIsRefused) {
  EXPECT_THAT(fault_of("/aaa"), HasSubstr("does not end"));
  EXPECT_THAT(fault_of("/a\0\0,fff"s), HasSubstr("type tags"));
  EXPECT_THAT(fault_of("/a\0\0,s\0\0abcd"s), HasSubstr("ends within"));
}

TEST(OscPacket, OtherProtocolsAreNamed) {
  EXPECT_THAT(fault_of("GET / HTTP/1.1\r\n\0\0\0\0"s), HasSubstr("no OSC"));
  EXPECT_THAT(fault_of("/a\0\0,x\0\0"s), HasSubstr("unknown type"));
}

TEST(OscPacket, TooManyArgumentsAreRefused) {
  MessageWriter writer("/a");
  for (std::size_t i = 0; i <= kMostArguments; ++i) writer.add(1.f);
  EXPECT_THAT(fault_of(writer.packet()), HasSubstr("more than 64"));
}

TEST(OscPacket, ABundleHasItsElements) {
  const std::vector parts{packet("/a", 1.f), packet("/b", 2.f)};
  const auto bytes = write_bundle(parts);
  const auto bundle = read_bundle(bytes_of(bytes));
  ASSERT_TRUE(bundle) << bundle.error().what;
  EXPECT_EQ(bundle->time_tag, kAtOnce);
  ASSERT_EQ(bundle->elements.size(), 2u);
}

TEST(OscPacket, ABundleWithAnImpossibleLengthIsRefused) {
  const auto head = write_bundle({});
  for (const auto& length :
       {"\xff\xff\xff\xff"s, "\xff\xff\xff\xfc"s, "\0\0\0\x10"s, "\0\0\0\3"s, "\0\0\0\0"s, "\0\0"s})
    EXPECT_FALSE(read_bundle(bytes_of(head + length + "/a\0\0,\0\0\0"s)));
  EXPECT_FALSE(read_bundle(bytes_of(head + "\0\0\0\0"s))) << "an element of no bytes";
  EXPECT_FALSE(read_bundle(bytes_of(head + "\0\0\0\3/a\0"s))) << "no multiple of four";
  EXPECT_FALSE(read_bundle(bytes_of("#bundle\0\0\0"s)));
  EXPECT_FALSE(read_bundle(bytes_of("#bungle\0\0\0\0\0\0\0\0\1"s)));
}

TEST(OscPattern, SignsStandForCharacters) {
  const auto is_like = [](std::string_view pattern, std::string_view address) {
    int steps = 10000;
    return matches(pattern, address, steps);
  };
  EXPECT_TRUE(is_like("/light/*", "/light/master"));
  EXPECT_FALSE(is_like("/*", "/light/master"));
  EXPECT_TRUE(is_like("/*/mas*r", "/light/master"));
  EXPECT_TRUE(is_like("/content/{left,right}", "/content/right"));
  EXPECT_FALSE(is_like("/content/{left,right}", "/content/rights"));
  EXPECT_TRUE(is_like("/a[0-3]?", "/a2x"));
  EXPECT_FALSE(is_like("/a[!0-3]", "/a2"));
  EXPECT_TRUE(is_like("/a[!0-3]", "/a7"));
  EXPECT_FALSE(is_like("/a?b", "/a/b"));
  EXPECT_TRUE(is_like("/a*", "/a"));
  EXPECT_TRUE(is_like("/{a,ab}c", "/abc"));
  EXPECT_FALSE(is_like("/a[bc", "/ab"));
  EXPECT_FALSE(is_like("/a{bc", "/ab"));
  EXPECT_FALSE(is_like("/abc", "/ab"));
}

TEST(OscPattern, OneThatWouldTakeForeverEnds) {
  std::string pattern = "/";
  for (int i = 0; i < 40; ++i) pattern += "*a";
  int steps = 10000;
  EXPECT_FALSE(matches(pattern + "b", "/" + std::string(200, 'a'), steps));
  EXPECT_LT(steps, 0);
}

}  // namespace
}  // namespace handcast::desk::osc
