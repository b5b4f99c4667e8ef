#include "io/visible_picture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "projection/error.hpp"
#include "tests/io/flir_file.hpp"
#include "tests/projection/random_cameras.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox::test {
namespace {

using testing::HasSubstr;

/// A picture that is 40 at its left and 200 at its right end, 60 x 20 pixels, as a file of this ending.
std::string encoded(const std::string& ending) {
  cv::Mat picture(20, 60, CV_8UC3, cv::Scalar(40, 40, 40));
  picture.colRange(30, 60).setTo(cv::Scalar(200, 200, 200));
  std::vector<std::uint8_t> bytes;
  cv::imencode(ending, picture, bytes);
  return {bytes.begin(), bytes.end()};
}

VisiblePicture decode(const std::string& bytes) {
  return decodeVisiblePicture(std::as_bytes(std::span(bytes)), "a.jpg");
}

std::string refusalOf(const std::string& bytes) {
  return messageOf<DataError>([&] { static_cast<void>(decode(bytes)); });
}

TEST(VisiblePicture, IsTheBrightnessOfAJpegOrPng) {
  for (const char* ending : {".jpg", ".png"}) {
    const VisiblePicture picture = decode(encoded(ending));
    ASSERT_EQ(picture.width, 60);
    ASSERT_EQ(picture.height, 20);
    ASSERT_EQ(picture.luminance.size(), 1200U);
    EXPECT_NEAR(picture.luminance[60 * 10 + 5], 40, 2) << ending;
    EXPECT_NEAR(picture.luminance[60 * 10 + 55], 200, 2) << ending;
  }
}

TEST(VisiblePicture, StaysAsStoredWhateverItsOrientation) {
  const std::string jpeg = encoded(".jpg");
  // A TIFF directory with the one entry orientation = 6, turned by 90 degrees.
  const std::string exif("Exif\0\0II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0", 32);
  const VisiblePicture picture = decode(jpeg.substr(0, 2) + appSegment(0xE1, exif) + jpeg.substr(2));
  EXPECT_EQ(picture.width, 60);
  EXPECT_EQ(picture.height, 20);
}

TEST(VisiblePicture, RefusesWhatIsCutOffOrNoPicture) {
  for (const char* ending : {".jpg", ".png"}) {
    const std::string whole = encoded(ending);
    for (const double share : {0.3, 0.7, 0.99}) {
      const auto length = static_cast<std::size_t>(share * static_cast<double>(whole.size()));
      EXPECT_THAT(refusalOf(whole.substr(0, length)), HasSubstr("a.jpg: is cut off")) << ending << share;
    }
  }
  for (const char* bytes : {"", "GIF89a", "timestamp,file"})
    EXPECT_THAT(refusalOf(bytes), HasSubstr("neither a JPEG nor a PNG"));
}

TEST(VisiblePicture, RefusesASizeThatItsBytesCannotHold) {
  std::string jpeg = encoded(".jpg");
  const std::size_t frame = jpeg.find("\xFF\xC0");
  ASSERT_NE(frame, std::string::npos);
  jpeg.replace(frame + 5, 4, "\xEA\x60\xEA\x60");
  EXPECT_THAT(refusalOf(jpeg), HasSubstr("size of the picture is damaged"));
  std::string png = encoded(".png");
  png.replace(16, 4, std::string("\0\0\xEA\x60", 4));
  EXPECT_THAT(refusalOf(png), HasSubstr("damaged"));
  png.replace(16, 4, "\xFF\xFF\xFF\xFF");
  EXPECT_THAT(refusalOf(png), HasSubstr("damaged"));
}

TEST(VisiblePicture, OfAFileHasToHaveTheSizeOfTheRigsCamera) {
  const TestFolder folder;
  const auto file = folder.write("v.jpg", encoded(".jpg"));
  const Camera fits(intrinsicsOf(LensModel::pinhole, {}, 60, 20));
  EXPECT_EQ(readVisiblePicture(file, "", fits).width, 60);
  const Camera other(intrinsicsOf(LensModel::pinhole, {}, 640, 480));
  EXPECT_THAT(messageOf<DataError>([&] { static_cast<void>(readVisiblePicture(file, "", other)); }),
              testing::AllOf(HasSubstr("v.jpg: is 60 x 20"), HasSubstr("640 x 480")));
  EXPECT_THAT(messageOf<DataError>(
                  [&] { static_cast<void>(readVisiblePicture(folder / "no.jpg", "visible.csv:3", fits)); }),
              testing::AllOf(HasSubstr("no.jpg"), HasSubstr("visible.csv:3")));
}

TEST(VisiblePicture, InARadiometricFileAsPngHasItsBrightnessInTheFirstChannel) {
  cv::Mat picture(4, 6, CV_8UC3, cv::Scalar(10, 20, 150));  // blue, green, red
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", picture, bytes);
  EmbeddedPicture embedded{.encoding = EmbeddedPicture::Encoding::png, .width = 6, .height = 4};
  for (const std::uint8_t byte : bytes) embedded.bytes.push_back(std::byte{byte});
  EXPECT_EQ(decodeVisiblePicture(embedded, "b60").luminance, std::vector<std::uint8_t>(24, 150));
}

}  // namespace
}  // namespace thermovox::test
