#include "io/csv.hpp"

#include <gmock/gmock.h>

#include <sstream>

#include "io/number_text.hpp"
#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using test::messageOf;
using testing::ElementsAre;
using testing::HasSubstr;

CsvReader reader(const std::string& text) {
  return {std::make_unique<std::istringstream>(text), "rows.csv"};
}

TEST(CsvReader, PassesOverTheHeaderAndBlankLines) {
  CsvReader csv = reader("timestamp,range\n\n1.5,2\n   \n2.5,3\n");
  ASSERT_TRUE(csv.next());
  EXPECT_THAT(csv.fields(), ElementsAre("1.5", "2"));
  EXPECT_EQ(csv.place(), "rows.csv:3");
  ASSERT_TRUE(csv.next());
  EXPECT_EQ(csv.place(), "rows.csv:5");
  EXPECT_FALSE(csv.next());
}

TEST(CsvReader, TakesOneHeaderOnly) {
  CsvReader csv = reader("a,b\nc,d\n");
  ASSERT_TRUE(csv.next());
  EXPECT_THAT(csv.fields(), ElementsAre("c", "d"));
}

TEST(CsvReader, KeepsAHeaderWhereRowsMayBeginWithLetters) {
  CsvReader csv(std::make_unique<std::istringstream>("\nname,other\nc,d\n"), "rows.csv",
                CsvReader::Header::keep);
  ASSERT_TRUE(csv.next());
  EXPECT_THAT(csv.fields(), ElementsAre("name", "other"));
}

TEST(CsvReader, ReadsAFirstRowThatIsNoHeader) {
  CsvReader csv = reader("1,2\nx,y\n");
  ASSERT_TRUE(csv.next());
  EXPECT_THAT(csv.fields(), ElementsAre("1", "2"));
}

TEST(CsvReader, TrimsFieldsAndEndsOfLinesOfAllSystems) {
  CsvReader csv = reader("\xEF\xBB\xBFtimestamp,file\r\n 1 ,\tthermal/a b.tiff \r\n2,x");
  ASSERT_TRUE(csv.next());
  EXPECT_THAT(csv.fields(), ElementsAre("1", "thermal/a b.tiff"));
  ASSERT_TRUE(csv.next());
  EXPECT_THAT(csv.fields(), ElementsAre("2", "x"));
}

TEST(CsvReader, ReadsRowsOfAnyLength) {
  std::string row = "0";
  for (int i = 1; i < 20000; ++i) row.append(",").append(std::to_string(i));
  CsvReader csv = reader(row);
  ASSERT_TRUE(csv.next());
  ASSERT_EQ(csv.fields().size(), 20000U);
  EXPECT_EQ(csv.number(19999), 19999.0);
}

TEST(CsvReader, KeepsStampsToTheNanosecond) {
  CsvReader csv = reader("1700000000.199999809,1");
  ASSERT_TRUE(csv.next());
  EXPECT_EQ(csv.stamp(0).time_since_epoch().count(), 1'700'000'000'199'999'809);
}

TEST(CsvReader, NamesFileLineAndTextOfWhatIsNoNumber) {
  CsvReader csv = reader("1,2\nnow,two\n");
  ASSERT_TRUE(csv.next());
  ASSERT_TRUE(csv.next());
  EXPECT_EQ(messageOf<DataError>([&] { static_cast<void>(csv.number(1)); }),
            "rows.csv:2: found 'two' as field 2, expected a number");
  EXPECT_EQ(messageOf<DataError>([&] { static_cast<void>(csv.stamp(0)); }),
            "rows.csv:2: found 'now', expected a timestamp in decimal seconds");
}

TEST(StampedRows, RefuseAClockThatDoesNotRunForwards) {
  for (const char* text : {"2,0\n1,0\n", "2,0\n2,0\n"}) {
    StampedRows rows(reader(text));
    ASSERT_TRUE(rows.next());
    EXPECT_THAT(messageOf<DataError>([&] { static_cast<void>(rows.next()); }),
                HasSubstr("rows.csv:2: timestamp"));
  }
}

TEST(ParseNumber, ReadsWhatProgramsWrite) {
  EXPECT_EQ(parseNumber("+5"), 5.0);
  EXPECT_EQ(parseNumber("-1.5e-3"), -0.0015);
  EXPECT_EQ(parseNumber("inf"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(parseNumber("-inf"), -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(parseNumber("nan").value()));
  EXPECT_TRUE(std::isnan(parseNumber("NaN").value()));
}

TEST(ParseNumber, RefusesWhatIsNotOneNumber) {
  for (const char* text : {"", "+", "+-5", "1,5", "1 2", "0x10", "five", "1.2.3", "1e999"}) {
    EXPECT_FALSE(parseNumber(text)) << text;
  }
}

TEST(IsPrintableUtf8, TakesWhatIsWellFormed) {
  for (const char* text : {"hall-2026-11-22", "Halle Süd", "東側", "\xF0\x9F\x94\xA5"})
    EXPECT_TRUE(isPrintableUtf8(text)) << text;
}

TEST(IsPrintableUtf8, RefusesDamagedSequencesAndControlCharacters) {
  for (const char* text : {"a\x1F", "a\x7F", "\xC2\x85", "\x80", "a\xC3", "\xC0\xAF", "\xE0\x80\x80",
                           "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xFF"})
    EXPECT_FALSE(isPrintableUtf8(text)) << inQuotes(text);
}

TEST(ExactText, ReadsBackAsTheSameNumber) {
  for (const double number : {0.1, 1.0 / 3.0, -2.356194490192345, 1e-300, 123456789.123456789}) {
    EXPECT_EQ(parseNumber(exactText(number)), number);
  }
}

}  // namespace
}  // namespace thermovox
