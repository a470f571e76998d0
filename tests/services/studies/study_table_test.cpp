// SPDX-License-Identifier: Apache-2.0
#include "services/studies/base/study_table.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "tests/scratch.hpp"
#include "tests/small_files.hpp"

namespace handcast::study {
namespace {

using testing::HasSubstr;

class StudyTables : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) const {
    std::ofstream(file_) << text;
    return file_;
  }
  test::Scratch scratch_;
  std::filesystem::path file_ = scratch_.path() / "table.csv";
};

TEST_F(StudyTables, ASpreadsheetsFileIsRead) {
  const auto table =
      read_study_table(write("\xef\xbb\xbfsubject,jnd_ms\r\n\"a, b\",1.5\r\n\r\nc,2"));
  ASSERT_TRUE(table) << table.error().what;
  EXPECT_THAT(table->columns, testing::ElementsAre("subject", "jnd_ms"));
  ASSERT_EQ(table->rows.size(), 2u);
  EXPECT_EQ(table->rows[0][0], "a, b");
  EXPECT_DOUBLE_EQ(*table->number(1, 1), 2);
}

TEST_F(StudyTables, FaultsAreNamedWithTheirPlace) {
  const auto uneven = read_study_table(write("a,b\n1,2\n3\n"));
  ASSERT_FALSE(uneven);
  EXPECT_THAT(uneven.error().what, HasSubstr("table.csv:3: the line has 1 cells, the heading 2"));
  const auto word = read_study_table(write("a,b\n1,two\n"));
  ASSERT_TRUE(word);
  EXPECT_THAT(word->number(0, 1).error().what, HasSubstr("row 1: b is 'two', which is no number"));
  EXPECT_THAT(word->column("c").error().what, HasSubstr("there is no column 'c'; there are a, b"));
  EXPECT_THAT(read_study_table(write("")).error().what, HasSubstr("the file is empty"));
  for (const auto* number : {"nan", "inf", "1e999", "1 ", ""})
    EXPECT_FALSE(
        read_study_table(write(std::string("a\n") + '"' + number + '"' + "\n"))->number(0, 0))
        << number;
}

TEST_F(StudyTables, ALogGoesOnBehindItsLastWholeLine) {
  const CsvRow columns{"a", "b"};
  { ASSERT_TRUE(StudyLog::open(file_, columns)->add(CsvRow{"1", "x"})); }
  std::ofstream(file_, std::ios::app) << "2,cut o";
  {
    auto log = StudyLog::open(file_, columns);
    ASSERT_TRUE(log) << log.error().what;
    ASSERT_EQ(log->earlier().rows.size(), 1u);
    ASSERT_TRUE(log->add(CsvRow{"2", "y"}));
  }
  const auto table = read_study_table(file_);
  ASSERT_TRUE(table);
  ASSERT_EQ(table->rows.size(), 2u);
  EXPECT_EQ(table->rows[1][1], "y");
}

TEST_F(StudyTables, AMarkOfTheEncodingCostsNoData) {
  write(
      "\xef\xbb\xbf"
      "a,b\n1,kept whole\n2,to");
  ASSERT_TRUE(StudyLog::open(file_, {"a", "b"}));
  const auto table = read_study_table(file_);
  ASSERT_TRUE(table);
  ASSERT_EQ(table->rows.size(), 1u);
  EXPECT_EQ(table->rows[0][1], "kept whole");
}

TEST_F(StudyTables, ALogOfAnySizeGoesOnWithoutItsRows) {
  std::string text = "a,b\n";
  while (text.size() < (17u << 20))
    text += "1,xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx\n";
  const auto whole = text.size();
  write(text + "2,tor");
  EXPECT_FALSE(StudyLog::open(file_, {"a", "b"})) << "it is larger than what is read";
  {
    auto log = StudyLog::open(file_, {"a", "b"}, StudyLog::Keeps::none);
    ASSERT_TRUE(log) << log.error().what;
    EXPECT_TRUE(log->earlier().rows.empty());
    EXPECT_EQ(std::filesystem::file_size(file_), whole);
    ASSERT_TRUE(log->add(CsvRow{"2", "y"}));
  }
  EXPECT_EQ(std::filesystem::file_size(file_), whole + 4);
  EXPECT_FALSE(StudyLog::open(file_, {"a", "c"}, StudyLog::Keeps::none));
}

TEST_F(StudyTables, WholeNumbersAreInTheirRange) {
  const auto table = read_study_table(write("a\n3\n1e300\n2.5\n"));
  ASSERT_TRUE(table);
  EXPECT_EQ(*table->whole(0, 0, 1, 5), 3);
  EXPECT_THAT(table->whole(1, 0, 1, 5).error().what, HasSubstr("a whole number, 1..5"));
  EXPECT_FALSE(table->whole(2, 0, 1, 5));
}

TEST_F(StudyTables, ALogOfAnotherKindAndOneThatIsOpenAreLeftAlone) {
  write("a,c\n1,2\n");
  EXPECT_THAT(StudyLog::open(file_, {"a", "b"}).error().what, HasSubstr("has other columns"));
  EXPECT_EQ(read_study_table(file_)->rows.size(), 1u);
  const auto log = StudyLog::open(file_, {"a", "c"});
  ASSERT_TRUE(log);
  EXPECT_THAT(StudyLog::open(file_, {"a", "c"}).error().what,
              HasSubstr("another program is writing"));
}

TEST_F(StudyTables, AFullDiskIsAnErrorAndTheLinesBeforeStay) {
  auto log = StudyLog::open(file_, {"a"});
  ASSERT_TRUE(log);
  ASSERT_TRUE(log->add(CsvRow{"kept"}));
  {
    const test::SmallFiles full(16);
    EXPECT_EQ(log->add(CsvRow{std::string(100, 'x')}).error().code, Errc::unavailable);
  }
  log = StudyLog::open(scratch_.path() / "other.csv", {"a"});
  const auto again = StudyLog::open(file_, {"a"});
  ASSERT_TRUE(again) << again.error().what;
  ASSERT_EQ(again->earlier().rows.size(), 1u);
  EXPECT_EQ(again->earlier().rows[0][0], "kept");
}

}  // namespace
}  // namespace handcast::study
