// SPDX-License-Identifier: Apache-2.0
#include "config/settings/document.hpp"

#include <gtest/gtest.h>

#include "config/settings/load.hpp"

namespace handcast::config {
namespace {

struct Lens {
  std::vector<double> coefficients{1, 2, 3};
  std::vector<double> free;
  std::vector<std::string> features;
};

template <class Visitor>
void describe(Visitor& visitor, Lens& lens) {
  visitor.field("coefficients", lens.coefficients, between(-10, 10), "Three numbers.");
  visitor.field("free", lens.free, at_least(0, "mm"), "Any numbers.");
  visitor.field("features", lens.features, "Any texts.");
}

std::string faults_of(const std::string& toml, Lens& lens) {
  const auto document = parse_document(toml, "lens.toml");
  EXPECT_TRUE(document) << document.error().what;
  Faults faults;
  apply_document(*document, "lens.toml", list_settings(lens), faults);
  return faults.to_error().what;
}

TEST(Document, KeepsTheOrderAndLinesOfTheFile) {
  const auto document = parse_document("z = 1\n\na = 'x'\n[t]\nb = [1, 2.5]\n", "f");
  ASSERT_TRUE(document);
  const auto& table = std::get<Table>(document->data);
  ASSERT_EQ(table.size(), 3u);
  EXPECT_EQ(table[0].name, "z");
  EXPECT_EQ(table[1].value.line, 3);
  EXPECT_EQ(table[2].name, "t");
  EXPECT_EQ(std::get<Table>(table[2].value.data)[0].value.line, 5);
}

TEST(Document, AListOfNumbersTakesWholeOnesToo) {
  Lens lens;
  EXPECT_EQ(faults_of("coefficients = [1, 2.5, -3]\nfree = [4]\n", lens), "");
  EXPECT_EQ(lens.coefficients, (std::vector<double>{1, 2.5, -3}));
  EXPECT_EQ(lens.free, (std::vector<double>{4}));
}

TEST(Document, AListThatIsBornWithElementsKeepsTheirNumber) {
  Lens lens;
  EXPECT_EQ(faults_of("coefficients = [1, 2]\n", lens),
            "lens.toml:1: coefficients: must be a list of 3 numbers, not of 2");
}

TEST(Document, AnElementOutsideTheRangeLeavesTheListAsItWas) {
  Lens lens;
  EXPECT_EQ(faults_of("coefficients = [1, 20, 3]\nfree = [-1]\n", lens),
            "lens.toml:1: coefficients: 20 is outside -10..10\nlens.toml:2: free: -1 is outside at "
            "least 0 mm");
  EXPECT_EQ(lens.coefficients, (std::vector<double>{1, 2, 3}));
}

TEST(Document, WhatIsInfiniteIsRefusedAlsoWhereTheRangeHasNoEnd) {
  Lens lens;
  EXPECT_EQ(faults_of("free = [inf]\n", lens), "lens.toml:1: free: inf is not a finite number");
}

TEST(Document, BothEndsOfARangeAreAllowed) {
  Lens lens;
  EXPECT_EQ(faults_of("coefficients = [-10, 10, 10.0]\n", lens), "");
}

TEST(Document, AnAssignedListMayGoWithoutBrackets) {
  Lens lens;
  Faults faults;
  apply_assignment("coefficients=4,5,6", list_settings(lens), faults);
  EXPECT_TRUE(faults.empty()) << faults.to_error().what;
  EXPECT_EQ(lens.coefficients, (std::vector<double>{4, 5, 6}));
}

TEST(Document, AListOfTextsTakesOnlyTexts) {
  Lens lens;
  EXPECT_EQ(faults_of("features = ['Gamma=1', \"a\"]\n", lens), "");
  EXPECT_EQ(lens.features, (std::vector<std::string>{"Gamma=1", "a"}));
  EXPECT_EQ(faults_of("features = ['b', 1]\n", lens),
            "lens.toml:1: features: must be a list of texts, not a whole number");
  EXPECT_EQ(faults_of("features = 'b'\n", lens),
            "lens.toml:1: features: must be a list of texts, not text");
  EXPECT_EQ(lens.features.size(), 2u);
}

TEST(Document, AnAssignedTextWithoutBracketsIsTheOnlyOneOfItsList) {
  Lens lens;
  for (const auto* assignment : {"features=Gamma=1,2", "features=[\"Gamma=1,2\"]"}) {
    Faults faults;
    apply_assignment(assignment, list_settings(lens), faults);
    EXPECT_TRUE(faults.empty()) << faults.to_error().what;
    EXPECT_EQ(lens.features, std::vector<std::string>{"Gamma=1,2"});
  }
}

TEST(Document, AKeyWithThousandsOfPartsIsRefusedAndDotsElsewhereAreNot) {
  std::string key = "a";
  for (int i = 0; i < 40'000; ++i) key += ".a";
  const auto deep = parse_document("name = 1\n" + key + " = 1\n", "rig.toml");
  ASSERT_FALSE(deep);
  EXPECT_EQ(deep.error().what, "rig.toml:2: a key has more than 32 parts");
  EXPECT_FALSE(parse_document("[" + key + "]\n", "rig.toml"));
  EXPECT_FALSE(parse_document("x = { " + key + " = 1 }\n", "rig.toml"));

  EXPECT_FALSE(parse_document("\"\\\"\"." + key + " = 1\n", "rig.toml")) << "an escaped quote";

  const std::string dots(100, '.');
  EXPECT_TRUE(parse_document("# " + dots + " don't " + dots + "\na = 1\n", "rig.toml"));
  EXPECT_TRUE(parse_document("a = \"" + dots + "\" # " + dots + "\n", "rig.toml"));
  std::string numbers = "0.5";
  for (int i = 0; i < 100; ++i) numbers += ", 0.5";
  EXPECT_TRUE(parse_document("a = [" + numbers + "]\n", "rig.toml"));
}

TEST(Document, AKeyWithThousandsOfPartsIsFoundBehindAStringOfThreeQuotes) {
  std::string key = "a";
  for (int i = 0; i < 20'000; ++i) key += ".a";
  // An odd number of quotes inside, escaped ones, those beside the closing three, none at all.
  for (const std::string text :
       {"'''it's'''", "''''a'''", "'''a''''", "'''a'''''", "''''''", "\"\"\"\"a\"\"\"",
        "\"\"\"\\\"\"\"\"", "\"\"\"a\\\"\"\"\"\"", "\"\"\"\"\"\"", "\"\"", "''", "'\'"}) {
    EXPECT_TRUE(parse_document("x = " + text + "\n", "rig.toml")) << text;
    const auto deep = parse_document("x = " + text + "\n" + key + " = 1\n", "rig.toml");
    ASSERT_FALSE(deep) << text;
    EXPECT_EQ(deep.error().what, "rig.toml:2: a key has more than 32 parts") << text;
    EXPECT_FALSE(parse_document("x = { t = " + text + ", " + key + " = 1 }\n", "rig.toml")) << text;
  }
  EXPECT_EQ(parse_document("x = '''\n\n'''\n" + key + " = 1\n", "rig.toml").error().what,
            "rig.toml:4: a key has more than 32 parts");
}

TEST(Document, DotsInsideAStringOfManyLinesArePartsOfNoKey) {
  const std::string dots(100, '.');
  for (const std::string quotes : {"'''", "\"\"\""}) {
    const auto text =
        quotes + "\n" + dots + " it's \"quoted" + dots + "\n# " + dots + "\n" + quotes;
    const auto document = parse_document("a = " + text + "\nb = 1\n", "rig.toml");
    ASSERT_TRUE(document) << document.error().what;
    EXPECT_EQ(std::get<Table>(document->data)[1].value.line, 5);
  }
}

}  // namespace
}  // namespace handcast::config
