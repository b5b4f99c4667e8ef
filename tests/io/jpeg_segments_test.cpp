#include "io/jpeg_segments.hpp"

#include <gtest/gtest.h>

#include <string>

#include "io/byte_order.hpp"
#include "tests/io/flir_file.hpp"

namespace thermovox {
namespace {

using namespace std::string_literals;

const std::string kStart = "\xFF\xD8";
const std::string kScan = "\xFF\xDA pixels \xFF\xE1\x00\x04 not a segment"s;

/// "E1:payload E2:other".
std::string told(const std::string& bytes) {
  std::string text;
  for (const JpegSegment& segment : jpegSegments(std::as_bytes(std::span(bytes)))) {
    constexpr char digits[] = "0123456789ABCDEF";
    text += text.empty() ? "" : " ";
    text += {digits[segment.marker >> 4], digits[segment.marker & 15], ':'};
    text += charactersOf(segment.payload);
  }
  return text;
}

std::string segment(int marker, const std::string& payload) {
  return test::appSegment(static_cast<std::uint8_t>(marker), payload);
}

TEST(JpegSegments, AreThoseBeforeThePicture) {
  EXPECT_EQ(told(kStart + segment(0xE1, "one") + segment(0xE3, "three") + kScan), "E1:one E3:three");
}

TEST(JpegSegments, MayHaveNoPayloadOrTheLongestThereIs) {
  const std::string longest(65533, 'x');
  EXPECT_EQ(told(kStart + segment(0xE1, "") + segment(0xE2, longest) + kScan), "E1: E2:" + longest);
}

TEST(JpegSegments, MayStandBehindFillBytesAndMarkersWithoutALength) {
  EXPECT_EQ(told(kStart + "\xFF\xFF\xFF" + segment(0xE1, "one") + "\xFF\xD0\xFF\x01" + segment(0xE2, "two")),
            "E1:one E2:two");
}

TEST(JpegSegments, EndWithTheImage) {
  EXPECT_EQ(told(kStart + segment(0xE1, "one") + "\xFF\xD9" + segment(0xE2, "two")), "E1:one");
}

TEST(JpegSegments, EndWhereNoMarkerStands) {
  EXPECT_EQ(told(kStart + segment(0xE1, "one") + "x" + segment(0xE2, "two")), "E1:one");
}

TEST(JpegSegments, EndAtALengthThatCannotBe) {
  for (const char length : {'\0', '\1'})
    EXPECT_EQ(told(kStart + segment(0xE1, "one") + "\xFF\xE2\0"s + length + segment(0xE3, "three")),
              "E1:one");
}

TEST(JpegSegments, LeaveOutTheOneThatClaimsMoreThanThereIs) {
  EXPECT_EQ(told(kStart + segment(0xE1, "one") + "\xFF\xE2\xFF\xFF" + std::string(65532, 'x')), "E1:one");
  EXPECT_EQ(told(kStart + "\xFF\xE2\x00\x06"s + "fou"), "");
}

TEST(JpegSegments, OfAFileThatIsCutOffAnywhereAreThoseThatAreWhole) {
  const std::string whole = kStart + segment(0xE1, "one") + segment(0xE2, "two");
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_EQ(told(whole.substr(0, size)), size < 9 ? "" : "E1:one") << size;
}

TEST(JpegSegments, OfOtherFilesAreNone) {
  for (const std::string& bytes : {""s, "\xFF"s, "II*\0"s, "\x89PNG"s, std::string(1000, '\xFF')})
    EXPECT_EQ(told(bytes), "");
}

}  // namespace
}  // namespace thermovox
