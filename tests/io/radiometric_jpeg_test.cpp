#include "io/radiometric_jpeg.hpp"

#include <gmock/gmock.h>

#include "io/celsius_decoder.hpp"
#include "projection/error.hpp"
#include "tests/io/flir_file.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using test::FlirFile;
using test::JpegCut;
using test::messageOf;
using testing::AllOf;
using testing::HasSubstr;

FlirFile smallFile() {
  return {.width = 24, .height = 18, .counts = test::calmCounts(24, 18), .parameters = test::e40()};
}

RawThermalImage readJpeg(const std::string& jpeg) {
  return openThermalRecording(std::as_bytes(std::span(jpeg)), "image.jpg")->read(0);
}

std::string complaintAbout(const std::string& jpeg) {
  return messageOf<DataError>(
      [&] { static_cast<void>(CelsiusDecoder().decode(readJpeg(jpeg), "image.jpg")); });
}

TEST(RadiometricJpeg, IsPutTogetherFromItsPieces) {
  const FlirFile file = smallFile();
  const std::string frame = flirFrame(file);
  for (const JpegCut& cut :
       {JpegCut{}, JpegCut{.piece_size = 100}, JpegCut{.piece_size = 100, .shuffled = true},
        JpegCut{.piece_size = 700, .numbered = false},
        JpegCut{.piece_size = 100,
        .before = test::exifSegment("FLIR Systems AB", "E40") + test::appSegment(0xE0, "JFIF")}}) {
    SCOPED_TRACE(testing::Message() << "pieces of " << cut.piece_size);
    EXPECT_EQ(readJpeg(test::radiometricJpeg(frame, cut)).counts, file.counts);
  }
}

TEST(RadiometricJpeg, MayHaveAPieceTwiceAndFillBytes) {
  const std::string frame = flirFrame(smallFile());
  std::string jpeg = test::radiometricJpeg(frame, {.piece_size = 1000});
  const std::string first =
      test::appSegment(0xE1, std::string("FLIR\0\x01\0\x03", 8) + frame.substr(0, 1000));
  jpeg.insert(2, "\xFF\xFF\xFF" + first);
  EXPECT_EQ(readJpeg(jpeg).counts, smallFile().counts);
}

TEST(RadiometricJpeg, TellsMakeAndModel) {
  FlirFile file = smallFile();
  const JpegCut cut{.before = test::exifSegment("FLIR Systems AB", "FLIR_E40")};
  EXPECT_EQ(readJpeg(test::radiometricJpeg(flirFrame(file), cut)).metadata.make, "FLIR Systems AB");
  EXPECT_EQ(readJpeg(test::radiometricJpeg(flirFrame(file), cut)).metadata.model, "FLIR E40")
      << "the frame's own";
  file.model = "";
  EXPECT_EQ(readJpeg(test::radiometricJpeg(flirFrame(file), cut)).metadata.model, "FLIR_E40");
}

TEST(RadiometricJpeg, IsRefusedWhenAPieceIsMissing) {
  const std::string frame = flirFrame(smallFile());
  std::string jpeg = test::radiometricJpeg(frame, {.piece_size = 1000});
  const std::size_t second = jpeg.find(std::string("FLIR\0\x01\x01", 7)) - 4;
  jpeg.erase(second, 1012);
  EXPECT_THAT(complaintAbout(jpeg), AllOf(HasSubstr("image.jpg: piece 2 of 4"), HasSubstr("is missing")));
}

TEST(RadiometricJpeg, IsRefusedWhenCutOffAnywhere) {
  const std::string jpeg = test::radiometricJpeg(flirFrame(smallFile()), {.piece_size = 900});
  const std::size_t scan = jpeg.rfind("\xFF\xDA");
  for (std::size_t size = 3; size < scan; size += 7) {
    SCOPED_TRACE(testing::Message() << size << " of " << jpeg.size() << " bytes");
    EXPECT_THAT(complaintAbout(jpeg.substr(0, size)), HasSubstr("image.jpg: "));
  }
  EXPECT_EQ(readJpeg(jpeg.substr(0, scan)).counts, smallFile().counts) << "the picture itself is not needed";
}

TEST(RadiometricJpeg, HasOneFrame) {
  const std::string jpeg = test::radiometricJpeg(flirFrame(smallFile()));
  const auto recording = openThermalRecording(std::as_bytes(std::span(jpeg)), "image.jpg");
  EXPECT_EQ(recording->frames(), 1);
  EXPECT_THAT(messageOf<DataError>([&] { static_cast<void>(recording->read(1)); }),
              HasSubstr("image.jpg: has no frame 1, expected 0"));
}

/// A JPEG of nothing but these segments.
std::string jpegOf(const std::string& segments) {
  return "\xFF\xD8" + segments + "\xFF\xDA\xFF\xD9";
}

TEST(JpegsWithoutAFlirFrame, AreNamedAsWhatTheyAre) {
  EXPECT_THAT(complaintAbout(jpegOf("")), HasSubstr("is a JPEG without radiometric data"));
  EXPECT_THAT(complaintAbout(jpegOf(test::exifSegment("Canon", "EOS R"))),
              HasSubstr("is a JPEG without radiometric data"));
  EXPECT_THAT(complaintAbout(jpegOf(test::exifSegment("FLIR Systems AB", "FLIR_i7"))),
              AllOf(HasSubstr("is a picture by FLIR_i7"), HasSubstr("without radiometric data")));
}

TEST(JpegsWithoutAFlirFrame, OfDjiAreRefusedWithTheWayOut) {
  std::string raw;
  for (int i = 0; i < 11; ++i) raw += test::appSegment(0xE3, std::string(60000, '\x10'));
  const std::string constants = test::appSegment(0xE4, "\xAA\x55\x12\x06" + std::string(100, '\1'));
  const auto expected = AllOf(HasSubstr("is a radiometric JPEG of DJI"), HasSubstr("convert it to a TIFF"));
  EXPECT_THAT(complaintAbout(jpegOf(test::exifSegment("DJI", "MAVIC2-ENTERPRISE-ADVANCED") + raw)),
              AllOf(expected, HasSubstr("MAVIC2-ENTERPRISE-ADVANCED")));
  EXPECT_THAT(complaintAbout(jpegOf(raw + constants)), expected);
  EXPECT_THAT(complaintAbout(jpegOf(test::exifSegment("DJI", "FC220"))),
              HasSubstr("is a JPEG without radiometric data"))
      << "a photo of a drone";
}

}  // namespace
}  // namespace thermovox
