#include "io/thermal_tiff_writer.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "io/celsius_decoder.hpp"
#include "io/thermal_recording.hpp"
#include "projection/error.hpp"
#include "tests/io/flir_file.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

TEST(ThermalTiffWriter, WritesTemperaturesThatReadBackAsTheyWere) {
  const test::TestFolder folder;
  const std::vector<ThermalImage> images{
      {.width = 3, .height = 2, .celsius = {1.5F, -40.0F, NAN, 0.0F, 550.25F, 9.0F}},
      {.width = 1, .height = 1, .celsius = {21.0F}},
      {.width = 2, .height = 1, .celsius = {3.0F, NAN}}};
  ThermalTiffWriter writer(folder / "c.tiff", Existing::refuse, {.pages = 3, .make = "FLIR", .model = "E40"});
  for (const ThermalImage& image : images) writer.add(image);
  EXPECT_FALSE(std::filesystem::exists(folder / "c.tiff")) << "not before it is whole";
  writer.commit();
  const auto recording = openThermalRecording(folder / "c.tiff");
  ASSERT_EQ(recording->frames(), 3);
  for (int page = 0; page < 3; ++page) {
    const RawThermalImage read = recording->read(page);
    const ThermalImage& written = images[static_cast<std::size_t>(page)];
    ASSERT_EQ(read.width, written.width);
    ASSERT_EQ(read.height, written.height);
    EXPECT_THAT(read.celsius, testing::Pointwise(testing::NanSensitiveFloatEq(), written.celsius));
    EXPECT_EQ(read.metadata.make, "FLIR");
    EXPECT_EQ(read.metadata.model, "E40");
    EXPECT_EQ(read.metadata.software, "thermovox");
  }
}

TEST(ThermalTiffWriter, SaysWhatTheCountsAre) {
  const test::TestFolder folder;
  const std::vector<std::uint16_t> counts = test::calmCounts(7, 5);
  const auto written = [&](const TiffPlan& plan) {
    ThermalTiffWriter writer(folder / "c.tiff", Existing::replace, plan);
    writer.add(7, 5, counts);
    writer.commit();
    return openThermalRecording(folder / "c.tiff")->read(0);
  };
  EXPECT_EQ(written({}).counts, counts);
  const RawThermalImage scaled = written({.make = "X", .model = "Y", .t_linear_gain = 0.02});
  EXPECT_EQ(std::get<TLinear>(scaled.rule).celsius_per_count, 0.02);
  EXPECT_EQ(scaled.rule_source, RuleSource::file);
  EXPECT_TRUE(std::holds_alternative<NotTemperature>(written({.t_linear_gain = 0.0}).rule));
}

TEST(ThermalTiffWriter, WritesABigTiffToo) {
  const test::TestFolder folder;
  const std::vector<std::uint16_t> counts = test::calmCounts(7, 5);
  ThermalTiffWriter writer(
      folder / "big.tiff", Existing::refuse,
      {.pages = 2, .make = "FLIR", .model = "Duo R", .t_linear_gain = 0.01, .big = true});
  for (int page = 0; page < 2; ++page) writer.add(7, 5, counts);
  writer.commit();
  EXPECT_EQ(test::bytesOf(folder / "big.tiff").substr(0, 4), std::string("II+\0", 4));
  const auto recording = openThermalRecording(folder / "big.tiff");
  ASSERT_EQ(recording->frames(), 2);
  EXPECT_EQ(recording->read(1).counts, counts);
  EXPECT_EQ(recording->read(1).metadata.model, "Duo R");
  EXPECT_EQ(recording->read(0).metadata.make, "FLIR");
}

}  // namespace
}  // namespace thermovox
