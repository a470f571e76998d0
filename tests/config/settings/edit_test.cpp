// SPDX-License-Identifier: Apache-2.0
#include "config/settings/edit.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <ostream>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "config/settings/document.hpp"
#include "config/settings/layout.hpp"

namespace handcast::config {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

Result<std::string> edited(const std::string& text,
                           const std::string& path = "projector.latency_ms",
                           const std::string& value = "10.2") {
  return with_value(text, path, value, "rig.toml");
}

/// A setting of a document by the keys that lead to it; null if there is none.
const Value* find(const Value& document, std::initializer_list<std::string_view> keys) {
  const Value* value = &document;
  for (const auto key : keys) {
    const auto* table = std::get_if<Table>(&value->data);
    if (table == nullptr) return nullptr;
    const auto member = std::ranges::find(*table, key, &Member::name);
    if (member == table->end()) return nullptr;
    value = &member->value;
  }
  return value;
}

struct Shape {
  const char* name;
  std::string before, after;
};

void PrintTo(const Shape& shape, std::ostream* out) { *out << shape.name; }

class Edit : public testing::TestWithParam<Shape> {};

TEST_P(Edit, ChangesTheValueAndNoOtherByte) {
  const auto text = edited(GetParam().before);
  ASSERT_TRUE(text) << text.error().what;
  EXPECT_EQ(*text, GetParam().after);
  EXPECT_EQ(*edited(*text), *text) << "the second edit changes nothing";
}

const std::string kText = R"(about = """
[projector]
latency_ms = 1 # "quoted" \""" not yet
"""" # four quotes end it
literal = '''
[projector]
latency_ms = 2 \''' # ends here
)";
const std::string kList = R"(list = [ # [projector]
  [1, 2], # latency_ms = 3
  { latency_ms = 4, projector.latency_ms = 5 },
  "]", '[projector]',
]
)";

INSTANTIATE_TEST_SUITE_P(
    Shapes, Edit,
    testing::Values(
        // The setting is there.
        Shape{"Section", "# mine\n[camera]\nlatency_ms = 1\n[projector]\n  latency_ms=3 # old\n",
              "# mine\n[camera]\nlatency_ms = 1\n[projector]\n  latency_ms=10.2 # old\n"},
        Shape{"BlanksAroundAll", "[ projector ]\t#x\n\tlatency_ms \t=\t 3\t# y\n",
              "[ projector ]\t#x\n\tlatency_ms \t=\t 10.2\t# y\n"},
        Shape{"DottedAtTheTop", "projector.latency_ms = 3\n", "projector.latency_ms = 10.2\n"},
        Shape{"DottedWithBlanks", "projector . latency_ms = 3 # a\n",
              "projector . latency_ms = 10.2 # a\n"},
        Shape{"InlineTable", "projector = { latency_ms = 3 }\n",
              "projector = { latency_ms = 10.2 }\n"},
        Shape{"InlineTableWithOthers", "projector={rate_hz=60,latency_ms=3,gamma=2.2}# a\n",
              "projector={rate_hz=60,latency_ms=10.2,gamma=2.2}# a\n"},
        Shape{"DottedInAnInlineTable", "a = 1\nprojector = { kms.a = 1, latency_ms = 3 }\n",
              "a = 1\nprojector = { kms.a = 1, latency_ms = 10.2 }\n"},
        Shape{"QuotedKeys", "[\"projector\"]\n'latency_ms' = 3\n",
              "[\"projector\"]\n'latency_ms' = 10.2\n"},
        Shape{"QuotedDottedKeys", "\"projector\".'latency_ms' = 3\n",
              "\"projector\".'latency_ms' = 10.2\n"},
        Shape{"WithoutALastLineEnd", "[projector]\nlatency_ms = 3",
              "[projector]\nlatency_ms = 10.2"},
        Shape{"CommentWithoutALastLineEnd", "[projector]\nlatency_ms = 3#",
              "[projector]\nlatency_ms = 10.2#"},
        Shape{"Crlf", "[projector]\r\nlatency_ms = 3\r\ngamma = 2\r\n",
              "[projector]\r\nlatency_ms = 10.2\r\ngamma = 2\r\n"},
        Shape{"ByteOrderMark", "\xEF\xBB\xBFprojector.latency_ms = 3\n",
              "\xEF\xBB\xBFprojector.latency_ms = 10.2\n"},
        Shape{"BehindTexts", kText + "[projector]\nlatency_ms = 3\n",
              kText + "[projector]\nlatency_ms = 10.2\n"},
        Shape{"BehindLists", kList + "[projector]\nlatency_ms = 3\n",
              kList + "[projector]\nlatency_ms = 10.2\n"},
        Shape{"BehindListsOfTables", "[[list]]\nlatency_ms = 1\n[projector]\nlatency_ms = 3\n",
              "[[list]]\nlatency_ms = 1\n[projector]\nlatency_ms = 10.2\n"},
        Shape{"HashAndBracketInTexts",
              "a = \"# [projector]\"\nb = '[x] # \"'\n[projector]\nlatency_ms = 3\n",
              "a = \"# [projector]\"\nb = '[x] # \"'\n[projector]\nlatency_ms = 10.2\n"},
        Shape{"BehindDates", "a = 2026-11-25 07:32:00 # b\n[projector]\nlatency_ms = 3\n",
              "a = 2026-11-25 07:32:00 # b\n[projector]\nlatency_ms = 10.2\n"},
        Shape{"AValueOfSeveralLines", "[projector]\nlatency_ms = [ # a\n 3, # b\n]# c\ngamma = 2\n",
              "[projector]\nlatency_ms = 10.2# c\ngamma = 2\n"},
        // The setting is absent.
        Shape{"NewLineInItsSection", "[projector] # light\nrate_hz = 60\n[camera]\n",
              "[projector] # light\nlatency_ms = 10.2\nrate_hz = 60\n[camera]\n"},
        Shape{"NewLineAsFarIn", "[projector]\n# why\n    rate_hz = 60\n",
              "[projector]\n    latency_ms = 10.2\n# why\n    rate_hz = 60\n"},
        Shape{"SectionWithoutALineEnd", "[projector]", "[projector]\nlatency_ms = 10.2\n"},
        Shape{"NewSection", "name = \"a\"\n", "name = \"a\"\n\n[projector]\nlatency_ms = 10.2\n"},
        Shape{"NewSectionWithoutALastLineEnd", "name = \"a\" # b",
              "name = \"a\" # b\n\n[projector]\nlatency_ms = 10.2\n"},
        Shape{"EmptyFile", "", "\n[projector]\nlatency_ms = 10.2\n"},
        Shape{"TheSectionOfABackEndIsAnotherOne", "[projector.kms]\nlatency_ms = 3\n",
              "[projector.kms]\nlatency_ms = 3\n\n[projector]\nlatency_ms = 10.2\n"},
        Shape{"BesideDottedKeys",
              "projector.rate_hz = 60 # a\nname = \"b\"\n[camera]\nrate_hz = 1\n",
              "projector.rate_hz = 60 # a\nprojector.latency_ms = 10.2\nname = \"b\"\n[camera]\n"
              "rate_hz = 1\n"},
        Shape{"BesideTheLastDottedKey",
              "projector.rate_hz = 60\nname = \"b\"\n  projector.gamma = 2",
              "projector.rate_hz = 60\nname = \"b\"\n  projector.gamma = 2\n"
              "  projector.latency_ms = 10.2\n"},
        Shape{"BehindADottedValueOfSeveralLines", "projector.kms.x = [\n 1,\n] # a\n",
              "projector.kms.x = [\n 1,\n] # a\nprojector.latency_ms = 10.2\n"},
        Shape{"InAnInlineTable", "projector = { rate_hz = 60 } # a\n",
              "projector = { rate_hz = 60, latency_ms = 10.2 } # a\n"},
        Shape{"InAnEmptyInlineTable", "projector = {}\n", "projector = { latency_ms = 10.2 }\n"},
        Shape{"InABlankInlineTable", "projector = { }\n", "projector = { latency_ms = 10.2 }\n"},
        Shape{"CrlfSection", "[projector]\r\ngamma = 2\r\n",
              "[projector]\r\nlatency_ms = 10.2\r\ngamma = 2\r\n"},
        Shape{"CrlfNewSection", "name = \"a\"\r\n# end",
              "name = \"a\"\r\n# end\r\n\r\n[projector]\r\nlatency_ms = 10.2\r\n"},
        Shape{"CrlfDotted", "projector.gamma = 2\r\n",
              "projector.gamma = 2\r\nprojector.latency_ms = 10.2\r\n"},
        Shape{"NotInAText", kText, kText + "\n[projector]\nlatency_ms = 10.2\n"},
        Shape{"NotInAList", kList, kList + "\n[projector]\nlatency_ms = 10.2\n"},
        Shape{"NotInAListOfTables", "[[list]]\nprojector.latency_ms = 1\n",
              "[[list]]\nprojector.latency_ms = 1\n\n[projector]\nlatency_ms = 10.2\n"}),
    [](const auto& shape) { return shape.param.name; });

TEST(EditPaths, ASettingOfTheTopGetsALineAboveTheFirstSection) {
  const auto name = [](const std::string& text) {
    return edited(text, "calibration", "\"a.toml\"");
  };
  EXPECT_EQ(*name("# mine\nname = \"b\" # c\n\n[camera]\n"),
            "# mine\nname = \"b\" # c\ncalibration = \"a.toml\"\n\n[camera]\n");
  EXPECT_EQ(*name("[camera]\nrate_hz = 1\n"),
            "calibration = \"a.toml\"\n\n[camera]\nrate_hz = 1\n");
  EXPECT_EQ(*name("calibration = '''b''' # c\n"), "calibration = \"a.toml\" # c\n");
}

TEST(EditPaths, ADeepSettingIsReachedThroughEachForm) {
  const auto deep = [](const std::string& text) { return edited(text, "twin.image.gain", "80"); };
  EXPECT_EQ(*deep("[twin]\nimage.gain = 1\n"), "[twin]\nimage.gain = 80\n");
  EXPECT_EQ(*deep("[twin]\nimage.noise = 1\n"), "[twin]\nimage.noise = 1\nimage.gain = 80\n");
  EXPECT_EQ(*deep("[twin]\nimage = {noise = 1}\n"), "[twin]\nimage = {noise = 1, gain = 80}\n");
  EXPECT_EQ(*deep("twin = { motion = \"a\" }\n"), "twin = { motion = \"a\", image.gain = 80 }\n");
  EXPECT_EQ(*deep("twin = { image.noise = 1, hands = \"left\" }\n"),
            "twin = { image.noise = 1, image.gain = 80, hands = \"left\" }\n");
  EXPECT_EQ(*deep("twin.image.noise = 1\n"), "twin.image.noise = 1\ntwin.image.gain = 80\n");
  EXPECT_EQ(*deep("twin.motion = \"a\"\n"), "twin.motion = \"a\"\n\n[twin.image]\ngain = 80\n");
}

TEST(EditPaths, WhatCannotBeEditedIsRefusedWithTheLineToWrite) {
  for (const char* text : {"[[projector]]\nlatency_ms = 3\n", "projector = 3\n",
                           "projector = [ { latency_ms = 3 } ]\n"}) {
    const auto refused = edited(text);
    ASSERT_FALSE(refused) << *refused;
    EXPECT_EQ(refused.error().code, Errc::bad_config);
    EXPECT_THAT(
        refused.error().what,
        AllOf(HasSubstr("rig.toml"), HasSubstr("write by hand: projector.latency_ms = 10.2")));
  }
  EXPECT_THAT(edited("[projector\nlatency_ms").error().what, HasSubstr("not TOML"));
}

TEST(EditPaths, AValueThatIsNoneOrMoreThanOneIsRefusedWithTheLineOfTheSetting) {
  for (const char* value : {"", "10.2 ms", "1\nname = \"b\"", "1\n[camera]", "# 1"}) {
    const auto refused =
        edited("name = \"a\"\n[projector]\nlatency_ms = 3\n", "projector.latency_ms", value);
    ASSERT_FALSE(refused) << *refused;
    EXPECT_THAT(refused.error().what, HasSubstr("rig.toml:3: "));
  }
}

/// Documents of random parts, each with two settings elsewhere: whatever the shape, the setting is
/// set, one stretch without a line end is replaced or one is added, and the rest stays.
TEST(EditPaths, OfAnyMixtureOfFormsEverythingElseStays) {
  const std::array tops{std::string("name = \"a\" # b\n"),
                        std::string("\n"),
                        std::string("# c\n"),
                        std::string("camera.rate_hz = 1\n"),
                        kText,
                        kList,
                        std::string("day = 2026-11-25\n")};
  const std::array<std::vector<std::string>, 6> forms{
      {{"projector.gamma = 2\n", "projector.latency_ms = 3\n"},
       {"projector.kms.a = 1\n"},
       {"projector = { gamma = 2 }\n"},
       {"projector = {latency_ms = 3,a.b=1}\n"},
       {},
       {}}};
  const std::array<std::string, 4> sections{
      "[projector.x]\na = 1\n", "[landmarks]\nb = '''\n[c]'''\n", "[[d]]\n[[d]]\nlatency_ms = 1\n",
      "  [e] # f\n  g = 1\n"};
  std::mt19937 random(1);
  for (int i = 0; i < 500; ++i) {
    std::vector<std::string> top, below;
    for (const auto& part : tops)
      if (random() % 2) top.push_back(part);
    const auto& form = forms[random() % forms.size()];
    top.insert(top.end(), form.begin(), form.end());
    std::ranges::shuffle(top, random);
    for (std::size_t k = form.empty() ? 0 : 1; k < sections.size(); ++k)
      if (random() % 2) below.push_back(sections[k]);
    if (form.empty() && random() % 2) below.push_back("[projector]\ngamma = 2 # h\n");
    std::ranges::shuffle(below, random);
    std::string text;
    for (const auto& part : top) text += part;
    for (const auto& part : below) text += part;
    if (random() % 3 == 0)
      for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2)
        text.insert(at, "\r");
    if (random() % 3 == 0 && !text.empty()) text.erase(text.find_last_not_of("\r\n") + 1);

    const auto after = edited(text);
    ASSERT_TRUE(after) << text << after.error().what;
    const auto document = parse_document(*after, "rig.toml");
    ASSERT_TRUE(document) << document.error().what;
    const auto* latency = find(*document, {"projector", "latency_ms"});
    ASSERT_TRUE(latency) << text << "---\n" << *after;
    ASSERT_TRUE(std::holds_alternative<double>(latency->data)) << *after;
    EXPECT_EQ(std::get<double>(latency->data), 10.2) << *after;
    const auto same = [](auto a, auto a_end, auto b, auto b_end) {
      return static_cast<std::size_t>(std::mismatch(a, a_end, b, b_end).first - a);
    };
    const auto front = same(text.begin(), text.end(), after->begin(), after->end());
    const auto back = std::min(same(text.rbegin(), text.rend(), after->rbegin(), after->rend()),
                               std::min(text.size(), after->size()) - front);
    const auto gone = text.substr(front, text.size() - front - back);
    EXPECT_TRUE(gone.empty() || gone == "3") << text << "---\n" << *after;
    EXPECT_EQ(*edited(*after), *after);
  }
}

TEST(LayoutOfText, WhatIsNoTomlHasSomeLayoutWithinTheText) {
  std::mt19937 random(2);
  const std::string characters = "[]{}=.,#\"'\\\n\r ax1";
  for (int i = 0; i < 20'000; ++i) {
    std::string text;
    for (auto length = random() % 30; length > 0; --length)
      text += characters[random() % characters.size()];
    const auto layout = layout_of(text);
    for (const auto& entry : layout.entries) {
      EXPECT_LE(entry.key.begin, entry.key.end);
      EXPECT_LE(entry.value.begin, entry.value.end);
      EXPECT_LE(entry.value.end, text.size());
    }
    (void)edited(text);
  }
}

}  // namespace
}  // namespace handcast::config
