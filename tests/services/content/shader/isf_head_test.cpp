// SPDX-License-Identifier: Apache-2.0
#include "services/content/shader/isf_head.hpp"

#include <gmock/gmock.h>

namespace handcast::content::shader {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Kind = Parameter::Kind;
using Type = IsfInput::Type;

IsfHead head_of(const std::string& json) {
  auto head = parse_isf_head("/*" + json + "*/ void main() {}");
  EXPECT_TRUE(head) << head.error().what;
  return head ? std::move(*head) : IsfHead{};
}

std::string head_fault(const std::string& text) {
  const auto head = parse_isf_head(text);
  return head ? "" : head.error().what;
}

TEST(IsfHead, EachTypeOfInputIsAParameter) {
  const auto head = head_of(R"({"INPUTS": [
    {"NAME": "hit", "TYPE": "event"},
    {"NAME": "on", "TYPE": "bool", "DEFAULT": true},
    {"NAME": "mode", "TYPE": "long", "VALUES": [3, 5], "LABELS": ["three", "five"], "DEFAULT": 5},
    {"NAME": "count", "TYPE": "long", "MIN": 1, "MAX": 9, "DEFAULT": 4},
    {"NAME": "speed", "TYPE": "float", "MIN": -1, "MAX": 2.5, "DEFAULT": 0.5, "LABEL": "How fast"},
    {"NAME": "place", "TYPE": "point2D", "MIN": [0, 0], "MAX": [1, 1], "DEFAULT": [0.2, 0.7]},
    {"NAME": "tint", "TYPE": "color", "DEFAULT": [1, 0.5, 0, 1]},
    {"NAME": "logo", "TYPE": "image"},
    {"NAME": "wave", "TYPE": "audio", "MAX": 64},
    {"NAME": "bands", "TYPE": "audioFFT"}]})");
  ASSERT_EQ(head.inputs.size(), 10u);
  const auto& in = head.inputs;
  EXPECT_EQ(in[0].parameter.kind, Kind::event);
  EXPECT_THAT(in[1].parameter.initial, ElementsAre(1));
  EXPECT_EQ(in[2].parameter.kind, Kind::choice);
  EXPECT_THAT(in[2].parameter.choices, ElementsAre("three", "five"));
  EXPECT_THAT(in[2].parameter.values, ElementsAre(3, 5));
  EXPECT_THAT(in[2].parameter.initial, ElementsAre(5));
  EXPECT_EQ(in[3].parameter.kind, Kind::whole);
  EXPECT_THAT(in[3].parameter.most, ElementsAre(9));
  EXPECT_EQ(in[4].parameter.label, "How fast");
  EXPECT_THAT(in[4].parameter.least, ElementsAre(-1));
  EXPECT_FALSE(in[5].is_in_pixels);
  EXPECT_THAT(in[6].parameter.initial, ElementsAre(1, 0.5, 0, 1));
  EXPECT_EQ(in[7].type, Type::image);
  EXPECT_EQ(in[8].most_samples, 64);
  EXPECT_EQ(in[9].type, Type::audio_fft);
}

TEST(IsfHead, WhatIsLeftOutHasASensibleValue) {
  const auto head = head_of(R"({"INPUTS": [
    {"NAME": "a", "TYPE": "float"}, {"NAME": "b", "TYPE": "float", "MIN": 2, "MAX": 5},
    {"NAME": "c", "TYPE": "float", "DEFAULT": 7}, {"NAME": "d", "TYPE": "point2D"},
    {"NAME": "e", "TYPE": "color"}, {"NAME": "f", "TYPE": "long", "LABELS": ["x", "y"]},
    {"NAME": "a", "TYPE": "bool"}]})");
  ASSERT_EQ(head.inputs.size(), 6u) << "the second 'a' is ignored";
  EXPECT_THAT(head.inputs[0].parameter.most, ElementsAre(1));
  EXPECT_THAT(head.inputs[1].parameter.initial, ElementsAre(2));
  EXPECT_THAT(head.inputs[2].parameter.most, ElementsAre(7));
  EXPECT_TRUE(head.inputs[3].is_in_pixels);
  EXPECT_THAT(head.inputs[3].parameter.initial, ElementsAre(0.5, 0.5));
  EXPECT_THAT(head.inputs[4].parameter.initial, ElementsAre(1, 1, 1, 1));
  EXPECT_THAT(head.inputs[5].parameter.values, ElementsAre(0, 1));
}

TEST(IsfHead, PassesHaveSizesAndKinds) {
  const auto head = head_of(R"json({"INPUTS": [{"NAME": "blur", "TYPE": "float"}], "PASSES": [
    {"TARGET": "small", "WIDTH": "$WIDTH / 4", "HEIGHT": 20, "PERSISTENT": true, "FLOAT": "1"},
    {"TARGET": "big", "WIDTH": "floor($blur * 8)", "HEIGHT": "100"}, {}]})json");
  ASSERT_EQ(head.passes.size(), 3u);
  EXPECT_TRUE(head.passes[0].is_persistent && head.passes[0].is_float);
  const auto size = [](std::string_view name) { return name == "WIDTH" ? 640. : 0.5; };
  EXPECT_EQ(head.passes[0].width->value(size), 160);
  EXPECT_EQ(head.passes[0].height->value(size), 20);
  EXPECT_EQ(head.passes[1].width->value(size), 4);
  EXPECT_EQ(head.passes[1].height->value(size), 100);
  EXPECT_FALSE(head.passes[2].width);
  EXPECT_EQ(head_of("{}").passes.size(), 1u) << "a file without PASSES has one";
}

TEST(IsfHead, Version1NamesItsBuffersInAListOrADictionary) {
  for (const auto* buffers : {R"(["last"])", R"({"last": {"WIDTH": "$WIDTH/2", "FLOAT": true}})",
                              R"([{"NAME": "last"}])"}) {
    const auto head = head_of(std::string(R"({"PERSISTENT_BUFFERS": )") + buffers +
                              R"(, "PASSES": [{"TARGET": "last"}, {}]})");
    EXPECT_TRUE(head.passes[0].is_persistent) << buffers;
    EXPECT_EQ(head.passes[0].width.has_value(),
              std::string(buffers).find("WIDTH") != std::string::npos);
    EXPECT_THAT(head.buffers, IsEmpty());
  }
  EXPECT_EQ(head_of(R"({"PERSISTENT_BUFFERS": ["alone"]})").buffers.size(), 1u);
}

TEST(IsfHead, ImportsAreAListOrADictionary) {
  for (const auto* imports :
       {R"({"logo": {"PATH": "a.png"}})", R"([{"NAME": "logo", "PATH": "a.png"}])",
        R"({"logo": "a.png"})", R"({"logo": {"PATH": ["a.png", "b.png"]}})"}) {
    const auto head = head_of(std::string(R"({"IMPORTED": )") + imports + "}");
    ASSERT_EQ(head.imports.size(), 1u) << imports;
    EXPECT_EQ(head.imports[0].name, "logo");
    EXPECT_EQ(head.imports[0].path, "a.png");
  }
}

TEST(IsfHead, WhatIsNoHeadIsNamed) {
  EXPECT_THAT(head_fault("void main() {}"), HasSubstr("no ISF file"));
  EXPECT_THAT(head_fault("/* a comment */ void main() {}"), HasSubstr("no ISF file"));
  EXPECT_THAT(head_fault("/*{ \"A\": 1"), HasSubstr("no end"));
  EXPECT_THAT(head_fault("// by me\n/*{\n\"A\": 1\n\"B\": 2\n}*/"), HasSubstr("line 4"));
  EXPECT_THAT(head_fault(R"(/*{"INPUTS": [{"NAME": "a", "TYPE": "flot"}]}*/)"),
              HasSubstr("'flot'"));
  EXPECT_THAT(head_fault(R"(/*{"INPUTS": [{"NAME": "a b", "TYPE": "float"}]}*/)"),
              HasSubstr("'a b'"));
  EXPECT_THAT(head_fault(R"(/*{"PASSES": [{"WIDTH": "$WIDTH /"}]}*/)"), HasSubstr("'$WIDTH /'"));
  EXPECT_THAT(head_fault(R"(/*{"PASSES": [{"WIDTH": "$nothing"}]}*/)"), HasSubstr("'nothing'"));
  EXPECT_THAT(head_fault(R"(/*{"PASSES": [{"TARGET": "a-b"}]}*/)"), HasSubstr("'a-b'"));
}

TEST(IsfHead, OddJsonIsAFaultOrNothingButNoCrash) {
  for (const auto* json :
       {"{\"INPUTS\": 3}", "{\"INPUTS\": [[]]}", "{\"INPUTS\": {\"a\": 1}}", "{\"PASSES\": \"x\"}",
        "{\"PASSES\": [1, \"a\", null]}", "{\"PERSISTENT_BUFFERS\": [[1]]}", "{\"IMPORTED\": 7}",
        "{\"INPUTS\": [{\"NAME\": {}, \"TYPE\": []}]}", "{}}", "{\"IMPORTED\": [1]}",
        "{\"INPUTS\": [{\"NAME\": \"a\", \"TYPE\": \"long\", \"VALUES\": {}}]}"})
    (void)parse_isf_head("/*" + std::string(json) + "*/");
  (void)parse_isf_head("/*{" + std::string(100'000, '[') + "}*/");
}

}  // namespace
}  // namespace handcast::content::shader
