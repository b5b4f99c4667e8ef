#include "io/png_counts.hpp"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <string_view>

#include "io/byte_order.hpp"
#include "projection/error.hpp"
#include "tests/io/flir_file.hpp"
#include "tests/support/memory_limit.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using test::zlibbed;

using test::messageOf;
using testing::AllOf;
using testing::HasSubstr;

CountsPicture decode(const std::string& bytes) {
  return decodePngCounts(std::as_bytes(std::span(bytes)), "picture");
}

std::string complaintAbout(const std::string& bytes) {
  return messageOf<DataError>([&] { static_cast<void>(decode(bytes)); });
}

std::vector<std::uint16_t> randomCounts(int width, int height, std::mt19937_64& random) {
  std::vector<std::uint16_t> counts(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const std::uint64_t noise = std::uint64_t{1} << random() % 17;
  for (std::uint16_t& count : counts) count = static_cast<std::uint16_t>(17000 + random() % noise);
  return counts;
}

/// An encoder that we did not write.
template <typename Pixel>
std::string encodedByOpenCv(const cv::Mat_<Pixel>& picture) {
  std::vector<unsigned char> png;
  cv::imencode(".png", picture, png);
  return {png.begin(), png.end()};
}

std::string bigEndian(std::uint32_t number) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift);
  return bytes;
}

std::string chunk(const std::string& type, const std::string& data) {
  return bigEndian(static_cast<std::uint32_t>(data.size())) + type + data + "crc.";
}

/// The header of a PNG of grey 16-bit pixels; `kind` is bits, colour type, compression, filter, interlace.
std::string header(std::uint32_t width, std::uint32_t height,
                   const std::string& kind = std::string("\x10\0\0\0\0", 5)) {
  return "\x89PNG\r\n\x1A\n" + chunk("IHDR", bigEndian(width) + bigEndian(height) + kind);
}

TEST(DecodePngCounts, GivesWhatOpenCvEncoded) {
  std::mt19937_64 random(31);
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 50}, {50, 1}, {37, 29}, {320, 240}}) {
    SCOPED_TRACE(testing::Message() << width << " x " << height);
    const std::vector<std::uint16_t> counts = randomCounts(width, height, random);
    cv::Mat_<std::uint16_t> picture(height, width);
    std::copy(counts.begin(), counts.end(), picture.begin());
    const CountsPicture decoded = decode(encodedByOpenCv(picture));
    EXPECT_EQ(decoded.width, width);
    EXPECT_EQ(decoded.height, height);
    EXPECT_EQ(decoded.counts, counts);
  }
}

TEST(DecodePngCounts, UndoesEveryFilterAndJoinsPieces) {
  std::mt19937_64 random(32);
  for (const auto& [width, height] : {std::pair{1, 5}, {2, 10}, {33, 17}, {160, 120}}) {
    const std::vector<std::uint16_t> counts = randomCounts(width, height, random);
    EXPECT_EQ(decode(test::grey16Png(width, height, counts)).counts, counts) << width << " x " << height;
  }
}

TEST(DecodePngCounts, IgnoresWhatFollowsItsEndAndChunksItDoesNotKnow) {
  const std::string data = zlibbed(std::string("\0\x12\x34", 3));
  const std::string png = header(1, 1) + chunk("tEXt", "FLIR") + chunk("IDAT", data.substr(0, 4)) +
                          chunk("IDAT", data.substr(4)) + chunk("IEND", "");
  EXPECT_EQ(decode(png).counts, std::vector<std::uint16_t>{0x1234});
  EXPECT_EQ(decode(png + "padding of a record").counts, std::vector<std::uint16_t>{0x1234});
}

TEST(DecodePngCounts, RefusesAPictureThatIsCutOffAnywhere) {
  const std::string png = test::grey16Png(60, 40, test::calmCounts(60, 40));
  const std::size_t end = png.find("IEND") - 4;
  for (std::size_t size = 0; size < end; size += 1 + size / 40) {
    SCOPED_TRACE(size);
    EXPECT_THAT(complaintAbout(png.substr(0, size)), HasSubstr("picture is "));
  }
}

TEST(DecodePngCounts, RefusesOtherPicturesByTheirPixels) {
  EXPECT_THAT(complaintAbout(encodedByOpenCv(cv::Mat_<unsigned char>(3, 4, std::uint8_t{0}))),
              AllOf(HasSubstr("4 x 3 pixels with 1 channel(s) of 8 bits"),
                    HasSubstr("expected one channel of 16 bits")));
  EXPECT_THAT(complaintAbout(encodedByOpenCv(cv::Mat_<cv::Vec3w>(3, 4, cv::Vec3w()))),
              HasSubstr("3 channel(s) of 16 bits"));
  EXPECT_THAT(complaintAbout(header(4, 3, std::string("\x10\0\0\0\x01", 5))), HasSubstr("interlaced"));
}

TEST(DecodePngCounts, RefusesWhatIsNoPngOrHasNoHeader) {
  for (const char* other : {"", "\x89PN", "\xFF\xD8\xFF\xE0 JFIF", "II*"})
    EXPECT_THAT(complaintAbout(other), HasSubstr("picture is no PNG"));
  EXPECT_THAT(complaintAbout("\x89PNG\r\n\x1A\n" + chunk("IEND", "")), HasSubstr("without a header"));
  EXPECT_THAT(complaintAbout("\x89PNG\r\n\x1A\n" + chunk("IHDR", bigEndian(4))), HasSubstr("damaged header"));
}

TEST(DecodePngCounts, RefusesChunksThatClaimMoreThanThereIs) {
  for (const std::uint32_t length : {14U, 0x7FFFFFFFU, 0xFFFFFFFFU}) {
    EXPECT_THAT(complaintAbout("\x89PNG\r\n\x1A\n" + bigEndian(length) + "IHDR" + std::string(17, '\0')),
                HasSubstr("cut off after 33 bytes"))
        << length;
  }
}

TEST(DecodePngCounts, RefusesMoreOrLessDataThanItsPixelsNeed) {
  const std::string row("\0\x12\x34", 3);
  for (const std::string& data : {row, row + row + row, std::string()}) {
    EXPECT_THAT(complaintAbout(header(1, 2) + chunk("IDAT", zlibbed(data)) + chunk("IEND", "")),
                AllOf(HasSubstr("damaged PNG"), HasSubstr("expected 6")));
  }
  EXPECT_THAT(complaintAbout(header(1, 2) + chunk("IEND", "")), HasSubstr("damaged PNG"));
  EXPECT_THAT(complaintAbout(header(1, 2) + chunk("IDAT", "no deflate") + chunk("IEND", "")),
              HasSubstr("damaged PNG"));
}

TEST(DecodePngCounts, RefusesAFilterThatPngDoesNotKnow) {
  for (const char filter : {'\5', '\xFF'}) {
    const std::string data = zlibbed(filter + std::string("\x12\x34"));
    EXPECT_THAT(complaintAbout(header(1, 1) + chunk("IDAT", data) + chunk("IEND", "")), HasSubstr("filter"));
  }
}

TEST(DecodePngCounts, TakesNoMemoryForPixelsThatAreNotThere) {
  const test::MemoryLimit limit(256'000'000);
  for (const auto& [width, height] :
       {std::pair{60'000U, 60'000U}, {0xFFFFFFFFU, 0xFFFFFFFFU}, {0U, 120U}, {10'000U, 10'000U}}) {
    EXPECT_THAT(complaintAbout(header(width, height) + chunk("IDAT", zlibbed("x")) + chunk("IEND", "")),
                HasSubstr("claims " + std::to_string(width) + " x " + std::to_string(height) + " pixels"));
  }
}

}  // namespace
}  // namespace thermovox
