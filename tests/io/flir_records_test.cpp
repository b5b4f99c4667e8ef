#include "io/flir_records.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "io/celsius_decoder.hpp"
#include "projection/error.hpp"
#include "tests/io/flir_file.hpp"
#include "tests/support/memory_limit.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using test::FlirFile;
using test::FlirPacking;
using test::messageOf;
using testing::AllOf;
using testing::HasSubstr;

FlirFile calmFile(int width = 40, int height = 30) {
  return {
      .width = width, .height = height, .counts = test::calmCounts(width, height), .parameters = test::e40()};
}

RawThermalImage readFrame(const std::string& bytes) {
  return readFlirFrame(FlirFrame(std::as_bytes(std::span(bytes)), "frame.fff"));
}

std::string complaintAbout(const std::string& bytes) {
  return messageOf<DataError>([&] { static_cast<void>(readFrame(bytes)); });
}

TEST(ReadFlirFrame, GivesTheCountsOfEveryPackingAndByteOrder) {
  for (const FlirPacking packing :
       {FlirPacking::raw_little, FlirPacking::raw_big, FlirPacking::png, FlirPacking::jpeg_ls}) {
    for (const ByteOrder container : {ByteOrder::little, ByteOrder::big}) {
      for (const ByteOrder records : {ByteOrder::little, ByteOrder::big}) {
        for (const auto& [width, height] : {std::pair(40, 30), std::pair(24, 32), std::pair(1, 7)}) {
          SCOPED_TRACE(testing::Message() << "packing " << static_cast<int>(packing) << ", container "
                                          << static_cast<int>(container) << ", records "
                                          << static_cast<int>(records) << ", " << width << " x " << height);
          FlirFile file = calmFile(width, height);
          file.packing = packing;
          file.container = container;
          file.records = records;
          const RawThermalImage image = readFrame(flirFrame(file));
          EXPECT_EQ(image.width, width);
          EXPECT_EQ(image.height, height);
          EXPECT_EQ(image.counts, file.counts);
          EXPECT_NEAR(std::get<RadiometricParameters>(image.rule).planck.r1, 14259.625, 1e-3);
        }
      }
    }
  }
}

TEST(ReadFlirFrame, SwapsThePngOfLittleEndianRecordsAndNoOther) {
  FlirFile file = calmFile();
  file.packing = FlirPacking::png;
  for (std::uint16_t& count : file.counts) count = static_cast<std::uint16_t>(count << 8);  // steps of 256
  EXPECT_EQ(readFrame(flirFrame(file)).counts, file.counts)
      << "what looks smoother swapped, but says nothing";
}

TEST(ReadFlirFrame, TakesThePngSamplesInTheOrderThatIsSmooth) {
  for (const ByteOrder records : {ByteOrder::little, ByteOrder::big}) {
    FlirFile file = calmFile();
    file.packing = FlirPacking::png;
    file.records = records;
    file.png_samples = records == ByteOrder::little ? ByteOrder::big : ByteOrder::little;
    EXPECT_EQ(readFrame(flirFrame(file)).counts, file.counts);
  }
}

TEST(ReadFlirFrame, ReadsCameraAndSurroundings) {
  FlirFile file = calmFile();
  file.parameters.emissivity = 0.9;
  file.parameters.distance = 12.5;
  file.parameters.reflected = -5.0;
  file.parameters.humidity = 0.25;
  file.picture_in_picture = true;
  file.visible_jpeg = "\xFF\xD8\xFF\xD9";
  const RawThermalImage image = readFrame(flirFrame(file));
  const auto& parameters = std::get<RadiometricParameters>(image.rule);
  EXPECT_FLOAT_EQ(static_cast<float>(parameters.emissivity), 0.9F);
  EXPECT_EQ(parameters.distance, 12.5);
  EXPECT_NEAR(parameters.reflected, -5.0, 1e-4);
  EXPECT_EQ(parameters.humidity, 0.25);
  EXPECT_EQ(parameters.planck.o, -5667.0);
  EXPECT_EQ(image.metadata.model, "FLIR E40");
  EXPECT_EQ(image.metadata.serial, "64502173");
  EXPECT_EQ(image.metadata.lens, "FOL18");
  EXPECT_EQ(image.metadata.time, "2013-04-12T09:24:01.131-01:00");
  EXPECT_NEAR(image.metadata.calibrated_range.value().high, 120.0, 1e-4);
  EXPECT_EQ(image.metadata.picture_in_picture.value().real_to_ir, 2.5);
  EXPECT_EQ(image.metadata.picture_in_picture.value().offset_y, -40);
  EXPECT_EQ(image.metadata.picture_in_picture.value().y2, 92);
  EXPECT_EQ(image.metadata.visible.value().bytes.size(), 4U);
  EXPECT_EQ(image.metadata.visible.value().width, 4);
  const std::string bytes = flirFrame(file);
  const RawThermalImage without =
      readFlirFrame(FlirFrame(std::as_bytes(std::span(bytes)), "frame.fff"), VisibleInFrame::leave_out);
  EXPECT_FALSE(without.metadata.visible);
  EXPECT_EQ(without.counts, image.counts);
}

TEST(ReadFlirFrame, GivesTheTemperaturesOfTheFormula) {
  const FlirFile file = calmFile();
  const RawThermalImage image = readFrame(flirFrame(file));
  const ThermalImage decoded = CelsiusDecoder().decode(image, "frame");
  const auto& parameters = std::get<RadiometricParameters>(image.rule);
  for (std::size_t i = 0; i < file.counts.size(); i += 97)
    EXPECT_NEAR(decoded.celsius[i], celsiusOfCounts(file.counts[i], parameters), 1e-4);
}

TEST(ReadFlirFrame, TakesTheUsualValueForWhatIsMissingOrCannotBe) {
  FlirFile file = calmFile();
  file.parameters.emissivity = 0.0;
  file.parameters.distance = -1.0;
  file.parameters.reflected = -300.0;
  file.parameters.humidity = 55.0;  // percent
  file.parameters.window_transmission = NAN;
  file.parameters.atmosphere = {0.0, 0.0, 0.0, 0.0, 0.0};
  const auto parameters = std::get<RadiometricParameters>(readFrame(flirFrame(file)).rule);
  const RadiometricParameters usual;
  EXPECT_EQ(parameters.emissivity, usual.emissivity);
  EXPECT_EQ(parameters.distance, usual.distance);
  EXPECT_EQ(parameters.reflected, usual.reflected);
  EXPECT_EQ(parameters.humidity, 0.55);
  EXPECT_EQ(parameters.window_transmission, usual.window_transmission);
  EXPECT_EQ(parameters.atmosphere, usual.atmosphere);
  parameters.validate();
}

TEST(ReadFlirFrame, GivesNoTemperatureWithoutEndByDamagedConstants) {
  FlirFile file = calmFile();
  file.parameters.planck.r2 = 1e27;
  file.parameters.planck.o = 1.8e9;
  const ThermalImage image = CelsiusDecoder().decode(readFrame(flirFrame(file)), "frame");
  for (const float celsius : image.celsius) EXPECT_TRUE(std::isnan(celsius)) << celsius;
}

TEST(ReadFlirFrame, LeavesOutWhatAnOlderCameraDoesNotWrite) {
  FlirFile file = calmFile();
  file.camera_info_size = 0x310;  // no time; the constants are there
  const RawThermalImage image = readFrame(flirFrame(file));
  EXPECT_EQ(image.metadata.time, "");
  EXPECT_EQ(std::get<RadiometricParameters>(image.rule).planck,
            std::get<RadiometricParameters>(readFrame(flirFrame(calmFile())).rule).planck);
  for (const std::size_t size : {std::size_t{4}, std::size_t{0x60}, std::size_t{0x30C}}) {
    file.camera_info_size = size;
    EXPECT_THAT(std::get<NotTemperature>(readFrame(flirFrame(file)).rule).reason, HasSubstr("no constants"));
  }
}

TEST(ReadFlirFrame, KnowsCamerasThatMeasureNoTemperatures) {
  for (const char* model : {"Vue Pro 640 13mm", "Vue 336", "FLIR Vue Pro", "Duo"})
    EXPECT_TRUE(measuresNoTemperatures(model)) << model;
  for (const char* model :
       {"Vue Pro R 640 13mm", "Duo Pro R", "FLIR_Duo_R", "FLIR E40", "", "FLIR Vue TZ20-R"})
    EXPECT_FALSE(measuresNoTemperatures(model)) << model;
  FlirFile file = calmFile();
  file.model = "Vue Pro 640 13mm";
  const RawThermalImage image = readFrame(flirFrame(file));
  EXPECT_EQ(image.counts, file.counts);
  EXPECT_THAT(messageOf<DataError>([&] { static_cast<void>(CelsiusDecoder().decode(image, "a.jpg")); }),
              AllOf(HasSubstr("a.jpg: is of a Vue Pro 640 13mm"), HasSubstr("no temperatures")));
}

TEST(ReadFlirFrame, RefusesAFrameThatIsCutOffAnywhere) {
  for (const FlirPacking packing :
       {FlirPacking::raw_little, FlirPacking::raw_big, FlirPacking::png, FlirPacking::jpeg_ls}) {
    FlirFile file = calmFile(20, 15);
    file.packing = packing;
    const std::string frame = flirFrame(file);
    testing::internal::CaptureStderr();
    // The last bytes of a packed picture are its end mark.
    for (std::size_t size = 0; size + 12 < frame.size(); size += 3) {
      SCOPED_TRACE(testing::Message() << size << " of " << frame.size() << " bytes");
      EXPECT_THAT(complaintAbout(frame.substr(0, size)), HasSubstr("frame.fff: "));
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "the library never prints";
  }
}

TEST(ReadFlirFrame, RefusesCountsOfAnotherSizeThanTheRecordSays) {
  FlirFile file = calmFile(20, 15);
  file.packing = FlirPacking::png;
  std::string frame = flirFrame(file);
  const std::size_t record = frame.find(std::string("\x02\0\x14\0\x0F\0", 6));
  ASSERT_NE(record, std::string::npos);
  frame[record + 2] = 21;
  EXPECT_THAT(complaintAbout(frame),
              AllOf(HasSubstr("holds a picture of 20 x 15"), HasSubstr("expected 21 x 15")));
}

TEST(ReadFlirFrame, TakesNoMemoryForAnImageThatItsBytesCannotHold) {
  const test::MemoryLimit limit(256'000'000);
  FlirFile file = calmFile(20, 15);
  std::string raw = flirFrame(file);
  const std::size_t record = raw.find(std::string("\x02\0\x14\0\x0F\0", 6));
  raw.replace(record + 2, 4, "\x60\xEA\x60\xEA");  // 60000 x 60000
  EXPECT_THAT(complaintAbout(raw), HasSubstr("expected 7200000000 for 60000 x 60000 counts"));
  file.packing = FlirPacking::png;
  std::string png = flirFrame(file);
  const std::size_t header = png.find("IHDR");
  png.replace(header + 4, 8, std::string("\0\0\xEA\x60\0\0\xEA\x60", 8));
  EXPECT_THAT(complaintAbout(png), HasSubstr("claims 60000 x 60000 pixels"));
  file.packing = FlirPacking::jpeg_ls;
  std::string jpeg_ls = flirFrame(file);
  const std::size_t size = jpeg_ls.find(std::string("\xFF\xF7\0\x0B\x10", 5));
  ASSERT_NE(size, std::string::npos);
  jpeg_ls.replace(size + 5, 4, "\xEA\x60\xEA\x60");
  EXPECT_THAT(complaintAbout(jpeg_ls), HasSubstr("claims 60000 x 60000 pixels"));
}

TEST(ReadFlirFrame, RefusesWhatIsNoFrame) {
  EXPECT_THAT(complaintAbout(""), HasSubstr("holds no FLIR frame"));
  std::string frame = flirFrame(calmFile());
  frame[0x14] = frame[0x17] = 0;
  EXPECT_THAT(complaintAbout(frame), HasSubstr("holds no FLIR frame of a known version"));
  std::string without_counts = flirFrame(calmFile());
  without_counts[64 + 2 * 32 + 1] = 0x23;  // the type of the third entry
  EXPECT_THAT(complaintAbout(without_counts), HasSubstr("holds no counts"));
}

}  // namespace
}  // namespace thermovox
