#include "io/exif.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "io/byte_order.hpp"

namespace thermovox {
namespace {

constexpr std::uint16_t kMake = 0x010F, kModel = 0x0110, kSoftware = 0x0131, kTime = 0x0132;
constexpr std::uint16_t kText = 2, kShort = 3;

/// A TIFF structure written byte by byte.
class Tiff {
 public:
  explicit Tiff(ByteOrder order) : order_(order), bytes_(order == ByteOrder::big ? "MM" : "II") {
    number(42, 2);
    number(8, 4);  // the directory follows
  }
  void number(std::uint32_t value, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i)
      bytes_ += static_cast<char>(value >> 8 * (order_ == ByteOrder::big ? size - 1 - i : i));
  }
  void entry(std::uint16_t tag, std::uint16_t type, std::uint32_t count, std::uint32_t value) {
    number(tag, 2);
    number(type, 2);
    number(count, 4);
    number(value, 4);
  }
  /// An entry whose four bytes hold the text themselves.
  void shortText(std::uint16_t tag, const std::string& four) {
    number(tag, 2);
    number(kText, 2);
    number(static_cast<std::uint32_t>(four.size()), 4);
    text(four + std::string(4 - four.size(), '\0'));
  }
  void text(const std::string& characters) { bytes_ += characters; }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  ByteOrder order_;
  std::string bytes_;
};

ExifFacts factsOf(const std::string& bytes) {
  return exifFacts(std::as_bytes(std::span(bytes)));
}

/// Four tags in a directory of 8 + 2 + 4 * 12 + 4 = 62 bytes, then their texts.
Tiff wholeTiff(ByteOrder order) {
  Tiff tiff(order);
  tiff.number(4, 2);
  tiff.entry(kMake, kText, 13, 62);
  tiff.shortText(kModel, "E40");
  tiff.entry(kSoftware, kText, 6, 75);
  tiff.entry(kTime, kText, 20, 81);
  tiff.number(0, 4);
  tiff.text(std::string("FLIR Systems\0", 13));
  tiff.text(std::string("v 2.1\0", 6));
  tiff.text(std::string("2013:04:12 10:24:01\0", 20));
  return tiff;
}

class ExifOfEitherOrder : public testing::TestWithParam<ByteOrder> {};

TEST_P(ExifOfEitherOrder, TellsItsTexts) {
  const ExifFacts facts = factsOf(wholeTiff(GetParam()).bytes());
  EXPECT_EQ(facts.make, "FLIR Systems");
  EXPECT_EQ(facts.model, "E40");
  EXPECT_EQ(facts.software, "v 2.1");
  EXPECT_EQ(facts.time, "2013:04:12 10:24:01");
}

TEST_P(ExifOfEitherOrder, TellsTheBeginningOfWhatIsCutOffAnywhere) {
  const std::string whole = wholeTiff(GetParam()).bytes();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    SCOPED_TRACE(size);
    const ExifFacts facts = factsOf(whole.substr(0, size));
    EXPECT_TRUE(std::string("FLIR Systems").starts_with(facts.make)) << facts.make;
    EXPECT_TRUE(std::string("E40").starts_with(facts.model)) << facts.model;
    EXPECT_TRUE(std::string("2013:04:12 10:24:01").starts_with(facts.time)) << facts.time;
    EXPECT_EQ(facts.time.empty(), size <= 81) << "its text begins at byte 81";
  }
}

TEST_P(ExifOfEitherOrder, LeavesOutWhatIsNoText) {
  Tiff tiff(GetParam());
  tiff.number(2, 2);
  tiff.entry(kMake, kShort, 13, 8);
  tiff.shortText(kModel, "E40");
  EXPECT_EQ(factsOf(tiff.bytes()).make, "");
  EXPECT_EQ(factsOf(tiff.bytes()).model, "E40");
}

TEST_P(ExifOfEitherOrder, LeavesOutATextThatClaimsAPlaceBeyondTheFile) {
  for (const std::uint32_t place : {100U, 0x7FFFFFFFU, 0xFFFFFFFFU}) {
    Tiff tiff(GetParam());
    tiff.number(2, 2);
    tiff.entry(kMake, kText, 0xFFFFFFFF, place);
    tiff.shortText(kModel, "E40");
    EXPECT_EQ(factsOf(tiff.bytes()).make, "") << place;
    EXPECT_EQ(factsOf(tiff.bytes()).model, "E40");
  }
}

TEST_P(ExifOfEitherOrder, BoundsATextThatClaimsToHaveNoEnd) {
  Tiff tiff(GetParam());
  tiff.number(1, 2);
  tiff.entry(kMake, kText, 0xFFFFFFFF, 22);
  tiff.text(std::string(100000, 'x'));
  EXPECT_EQ(factsOf(tiff.bytes()).make, std::string(256, 'x'));
}

TEST_P(ExifOfEitherOrder, EndsWithItsBytesWhateverTheNumberOfTagsItClaims) {
  Tiff tiff(GetParam());
  tiff.number(65535, 2);
  tiff.shortText(kModel, "E40");
  EXPECT_EQ(factsOf(tiff.bytes()).model, "E40");
  EXPECT_EQ(factsOf(tiff.bytes()).make, "");
}

TEST_P(ExifOfEitherOrder, HasNothingToTellWithADirectoryBeyondTheFile) {
  for (const std::uint32_t place : {62U, 0xFFFFFFFFU}) {
    Tiff tiff(GetParam());
    const std::size_t directory = 4;
    Tiff other(GetParam());
    std::string bytes = tiff.bytes();
    other.number(place, 4);
    bytes.replace(directory, 4, other.bytes().substr(8));
    EXPECT_EQ(factsOf(bytes).make, "");
  }
}

INSTANTIATE_TEST_SUITE_P(Both, ExifOfEitherOrder, testing::Values(ByteOrder::little, ByteOrder::big),
                         [](const auto& test) { return test.param == ByteOrder::little ? "little" : "big"; });

}  // namespace
}  // namespace thermovox
