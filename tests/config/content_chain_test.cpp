// SPDX-License-Identifier: Apache-2.0
#include "config/content_chain.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace handcast;
using namespace handcast::config;
using testing::HasSubstr;

namespace {

ContentChain read(std::string_view text) {
  const auto chain = parse_content(text);
  EXPECT_TRUE(chain) << text << ": " << chain.error().what;
  return chain.value_or(ContentChain{});
}

ContentElement one(std::string_view text) {
  const auto chain = read(text);
  EXPECT_EQ(chain.size(), 1u) << text;
  return chain.empty() ? ContentElement{} : chain[0];
}

using Parameters = std::vector<std::pair<std::string, std::string>>;

TEST(ContentChain, ReadsElementsWithTheirParametersInOrder) {
  const auto chain = read(
      "film:a.mp4 speed=0.5 | isf:kaleidoscope.fs sides=6 | text:Hello colour=#ff8800 "
      "opacity=0.5");
  ASSERT_EQ(chain.size(), 3u);
  EXPECT_EQ(chain[0].kind, "film");
  EXPECT_EQ(chain[0].what, "a.mp4");
  EXPECT_EQ(chain[0].parameters, (Parameters{{"speed", "0.5"}}));
  EXPECT_EQ(chain[1].kind, "isf");
  EXPECT_EQ(chain[2].parameters, (Parameters{{"colour", "#ff8800"}, {"opacity", "0.5"}}));
}

TEST(ContentChain, ChoosesTheKindByTheNameOfTheFile) {
  EXPECT_EQ(one("tiger").kind, "look");
  EXPECT_EQ(one("a.PNG").kind, "picture");
  EXPECT_EQ(one("/home/me/a film.mp4").kind, "film");
  EXPECT_EQ(one("waves.fs").kind, "isf");
  EXPECT_EQ(one("waves.frag").kind, "shadertoy");
  EXPECT_EQ(one("/dev/video2").kind, "capture");
  EXPECT_EQ(one("rtsp://camera/1").kind, "film");
  EXPECT_EQ(one("folder.fs/name").kind, "picture") << "another path may be one";
  EXPECT_EQ(one("builtin:atlas").kind, "pattern");
  EXPECT_EQ(one("projegraphy").kind, "projegraphy") << "a source that needs no name";
  EXPECT_EQ(one("projegraphy").what, "");
  EXPECT_EQ(one("look:paint").kind, "look");
  EXPECT_EQ(one("builtin:atlas").what, "atlas");
}

TEST(ContentChain, AddressesKeepTheirQuestionMarksAndEquals) {
  EXPECT_EQ(one("http://host:8080/a?x=1&y=2").what, "http://host:8080/a?x=1&y=2");
  EXPECT_TRUE(one("http://host:8080/a?x=1&y=2").parameters.empty());
  const auto film = one("film:rtsp://u:p@host/a?x=1 opacity=0.5");
  EXPECT_EQ(film.kind, "film");
  EXPECT_EQ(film.what, "rtsp://u:p@host/a?x=1");
  EXPECT_EQ(film.parameters, (Parameters{{"opacity", "0.5"}}));
}

TEST(ContentChain, FilesMayHaveSpaces) {
  const auto film = one("/home/me/my holiday film.mp4 speed=2");
  EXPECT_EQ(film.what, "/home/me/my holiday film.mp4");
  EXPECT_EQ(film.parameters, (Parameters{{"speed", "2"}}));
  EXPECT_EQ(one("picture:a = b.png").what, "a = b.png");
}

TEST(ContentChain, QuotedValuesMayHaveSpacesAndBars) {
  const auto text = one(R"(text:Hi font="DejaVu Sans Bold" size=0.2)");
  EXPECT_EQ(text.what, "Hi");
  EXPECT_EQ(text.parameters, (Parameters{{"font", "DejaVu Sans Bold"}, {"size", "0.2"}}));
  const auto bar = one(R"(text:Hi font="a | b")");
  EXPECT_EQ(bar.parameters, (Parameters{{"font", "a | b"}}));
  EXPECT_EQ(one(R"(text:Hi font="")").parameters, (Parameters{{"font", ""}}));
  EXPECT_EQ(one(R"(text:Hi a="x=1 y=2" b=3)").parameters,
            (Parameters{{"a", "x=1 y=2"}, {"b", "3"}}));
}

TEST(ContentChain, AQuotedTextMayHaveBarsAndEquals) {
  EXPECT_EQ(one(R"(text:"a | b")").what, "a | b");
  const auto sum = one(R"(text:"E = m size=2" size=0.3)");
  EXPECT_EQ(sum.what, "E = m size=2");
  EXPECT_EQ(sum.parameters, (Parameters{{"size", "0.3"}}));
  EXPECT_EQ(one(R"(text:"say \"hi\"")").what, R"(say "hi")");
}

TEST(ContentChain, TextsKeepTheirColons) {
  EXPECT_EQ(one("clock:%H:%M:%S").what, "%H:%M:%S");
  EXPECT_EQ(one("text:Note: this").what, "Note: this");
  EXPECT_EQ(one("text:").what, "");
}

TEST(ContentChain, WhatIsPrintedIsReadAsTheSame) {
  const ContentChain chain{{"text", "a | b", {{"font", "DejaVu Sans"}, {"empty", ""}}},
                           {"text", "x size=2", {}},
                           {"text", R"(say "hi" \ there)", {{"note", R"(a "b" \)"}}},
                           {"text", "", {}},
                           {"text", "  spaces at the ends  ", {{"t", " x "}}},
                           {"text", "two\nlines", {{"bar", "a | b"}}},
                           {"film", "rtsp://host/a?x=1&y=2", {{"opacity", "0.5"}}},
                           {"picture", "/a folder/b = c.png", {{"fit", "cover"}}},
                           {"look", "tiger", {{"speed", "2"}}}};
  const auto again = read(print_content(chain));
  ASSERT_EQ(again.size(), chain.size()) << print_content(chain);
  for (std::size_t i = 0; i < chain.size(); ++i) {
    EXPECT_EQ(again[i].kind, chain[i].kind);
    EXPECT_EQ(again[i].what, chain[i].what);
    EXPECT_EQ(again[i].parameters, chain[i].parameters);
  }
}

TEST(ContentChain, PlainContentIsPrintedWithoutQuotes) {
  EXPECT_EQ(print_content(read("a film.mp4 speed=2 | tiger")), "a film.mp4 speed=2 | tiger");
}

TEST(ContentChain, ErrorsAreSentences) {
  EXPECT_THAT(parse_content("").error().what, HasSubstr("content is empty"));
  EXPECT_THAT(parse_content("   ").error().what, HasSubstr("content is empty"));
  EXPECT_THAT(parse_content("a.png | ").error().what, HasSubstr("content is empty"));
  EXPECT_THAT(parse_content("a.png |  | b.png").error().what, HasSubstr("content is empty"));
  EXPECT_THAT(parse_content(" | b.png").error().what, HasSubstr("content is empty"));
  EXPECT_THAT(parse_content("film:").error().what, HasSubstr("content is empty"));
  EXPECT_THAT(parse_content("text:\"a\" b").error().what, HasSubstr("no name=value"));
  EXPECT_THAT(parse_content("text:a font=\"b").error().what, HasSubstr("not closed"));
  for (const auto* text : {"", "film:", "text:a font=\"b"})
    EXPECT_EQ(parse_content(text).error().code, Errc::bad_config);
}

TEST(ContentChain, NoTextMakesItFail) {
  const std::string letters = "a:|=\"\\ .5\n";
  unsigned random = 1;
  for (int i = 0; i < 20'000; ++i) {
    std::string text;
    for (unsigned k = 0; k < random % 17; ++k) {
      random = random * 1664525u + 1013904223u;
      text += letters[(random >> 16) % letters.size()];
    }
    random = random * 1664525u + 1013904223u;
    const auto chain = parse_content(text);
    if (!chain) continue;
    const auto again = parse_content(print_content(*chain));
    ASSERT_TRUE(again) << text;
    ASSERT_EQ(print_content(*again), print_content(*chain)) << text;
    ASSERT_EQ(again->size(), chain->size()) << text;
    for (std::size_t k = 0; k < chain->size(); ++k)
      ASSERT_EQ((*again)[k].what, (*chain)[k].what) << text;
  }
}

TEST(ContentChain, AFileInsideAViewIsResolvedToo) {
  EXPECT_EQ(*resolve_content("view:a.png bake=1 | b.fs", "/show"),
            "view:/show/a.png bake=1 | /show/b.fs");
  EXPECT_EQ(*resolve_content("view:film:a.mp4", "/show"), "view:/show/a.mp4");
  EXPECT_EQ(resolve_content("view:", "/show").error().code, Errc::bad_config);
}

TEST(ContentChain, FilesAndStillPicturesAreTold) {
  EXPECT_TRUE(is_content_file(one("a.png")));
  EXPECT_TRUE(is_content_file(one("a.mp4")));
  EXPECT_FALSE(is_content_file(one("rtsp://a/b")));
  EXPECT_FALSE(is_content_file(one("text:a.png")));
  EXPECT_TRUE(is_still(read("a.png")));
  EXPECT_TRUE(is_still(read("builtin:atlas")));
  EXPECT_FALSE(is_still(read("a.png opacity=0.5")));
  EXPECT_FALSE(is_still(read("a.png | b.png")));
  EXPECT_FALSE(is_still(read("a.mp4")));
}

}  // namespace
