#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <numeric>

#include "io/celsius_decoder.hpp"
#include "io/thermal_recording.hpp"
#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

// Files of real cameras, against numbers that an independent program computed from them.

namespace thermovox {
namespace {

using nlohmann::json;
using test::messageOf;
using testing::AllOf;
using testing::HasSubstr;

constexpr double kTolerance = 0.01;  // C, of the published formula against itself, rounded to 4 digits there

std::filesystem::path thermalFolder() {
  return *test::recordings() / "thermal";
}

json reference(const std::string& part) {
  return json::parse(test::bytesOf(thermalFolder() / "reference.json")).at(part);
}

void expectPixels(const std::vector<float>& pixels, int width, const json& expected, double tolerance) {
  for (const auto& [where, pixel] : expected.items()) {
    const auto [u, v] = pixel.at("xy").get<std::array<int, 2>>();
    EXPECT_NEAR(static_cast<double>(pixels.at(static_cast<std::size_t>(v * width + u))),
                pixel.at("v").get<double>(), tolerance)
        << where;
  }
}

void expectCounts(const RawThermalImage& image, const json& expected) {
  const auto [low, high] = std::minmax_element(image.counts.begin(), image.counts.end());
  EXPECT_EQ(*low, expected.at("raw_min").get<int>());
  EXPECT_EQ(*high, expected.at("raw_max").get<int>());
  if (expected.contains("wh")) {
    EXPECT_EQ((std::array{image.width, image.height}), (expected.at("wh").get<std::array<int, 2>>()));
    const double sum = std::accumulate(image.counts.begin(), image.counts.end(), 0.0);
    EXPECT_NEAR(sum / static_cast<double>(image.counts.size()), expected.at("raw_mean").get<double>(), 1e-4);
    expectPixels({image.counts.begin(), image.counts.end()}, image.width, expected.at("raw_pixels"), 0.0);
  }
}

void expectCelsius(const RawThermalImage& image, const RadiometricOverrides& overrides,
                   const json& expected) {
  const ThermalImage decoded = CelsiusDecoder().decode(image, "image", overrides);
  const ThermalStatistics statistics = statisticsOf(decoded, std::nullopt);
  EXPECT_NEAR(statistics.min.value(), expected.at("min").get<double>(), kTolerance);
  EXPECT_NEAR(statistics.max.value(), expected.at("max").get<double>(), kTolerance);
  EXPECT_NEAR(statistics.mean.value(), expected.at("mean").get<double>(), kTolerance);
  EXPECT_EQ(statistics.unknown, expected.at("nan_pixels").get<std::size_t>());
  expectPixels(decoded.celsius, decoded.width, expected.at("pixels_C"), kTolerance);
}

void expectParameters(const RawThermalImage& image, const json& expected) {
  const auto& p = std::get<RadiometricParameters>(image.rule);
  const auto same = [&](const char* key, double value) {
    const double wanted = expected.at(key).get<double>();
    EXPECT_NEAR(value, wanted, 1e-6 * std::max(1.0, std::abs(wanted))) << key;
  };
  same("Emissivity", p.emissivity);
  same("ObjectDistance", p.distance);
  same("ReflectedApparentTemperature", p.reflected);
  same("AtmosphericTemperature", p.atmosphere_temperature);
  same("IRWindowTemperature", p.window_temperature);
  same("IRWindowTransmission", p.window_transmission);
  same("RelativeHumidity", p.humidity);
  same("PlanckR1", p.planck.r1);
  same("PlanckB", p.planck.b);
  same("PlanckF", p.planck.f);
  same("PlanckO", p.planck.o);
  same("PlanckR2", p.planck.r2);
  same("AtmosphericTransAlpha1", p.atmosphere.alpha1);
  same("AtmosphericTransAlpha2", p.atmosphere.alpha2);
  same("AtmosphericTransBeta1", p.atmosphere.beta1);
  same("AtmosphericTransBeta2", p.atmosphere.beta2);
  same("AtmosphericTransX", p.atmosphere.x);
}

const RadiometricOverrides kOverridden{
    .emissivity = 0.7, .distance = 30.0, .reflected = -40.0, .atmosphere_temperature = 10.0, .humidity = 0.8};

RadiometricOverrides by(AtmosphereModel model, RadiometricOverrides overrides = {}) {
  overrides.model = model;
  return overrides;
}

TEST(RealRadiometricFiles, GiveTheCountsParametersAndTemperaturesOfTheReference) {
  THERMOVOX_NEEDS_RECORDINGS();
  const json files = reference("radiometric");
  ASSERT_GE(files.size(), 9U);
  for (const auto& [name, expected] : files.items()) {
    SCOPED_TRACE(name);
    const auto recording = openThermalRecording(thermalFolder() / name);
    ASSERT_EQ(recording->frames(), expected.at("frames").get<int>());
    const RawThermalImage image = recording->read(0);
    expectCounts(image, expected);
    EXPECT_EQ(image.metadata.model.empty() ? "" : expected.at("model").get<std::string>(),
              expected.at("model").get<std::string>());
    expectParameters(image, expected.at("params"));
    for (const AtmosphereModel model : {AtmosphereModel::half, AtmosphereModel::single}) {
      const char* key = model == AtmosphereModel::half ? "half" : "single";
      SCOPED_TRACE(key);
      expectCelsius(image, by(model), expected.at(key));
      expectCelsius(image, by(model, kOverridden),
                    expected.at("override_E0.7_OD30_RH0.8_Ta10_Tr-40").at(key));
    }
    EXPECT_EQ(std::get<RadiometricParameters>(image.rule).model, AtmosphereModel::single) << "the default";
  }
}

TEST(RealRadiometricFiles, GiveEveryFrameOfARecording) {
  THERMOVOX_NEEDS_RECORDINGS();
  const json files = reference("radiometric");
  for (const auto& [name, expected] : files.items()) {
    if (!expected.contains("later_frames")) continue;
    const auto recording = openThermalRecording(thermalFolder() / name);
    int frame = 1;
    for (const json& later : expected.at("later_frames")) {
      SCOPED_TRACE(name + " " + std::to_string(frame));
      const RawThermalImage image = recording->read(frame++);
      expectCounts(image, later);
      expectCelsius(image, by(AtmosphereModel::half), later.at("half"));
    }
    EXPECT_EQ(frame, recording->frames());
  }
}

TEST(RealRadiometricFiles, TellTheVisiblePictureAndItsPlace) {
  THERMOVOX_NEEDS_RECORDINGS();
  const json files = reference("radiometric");
  for (const auto& [name, expected] : files.items()) {
    SCOPED_TRACE(name);
    const ThermalMetadata metadata = openThermalRecording(thermalFolder() / name)->read(0).metadata;
    ASSERT_EQ(metadata.picture_in_picture.has_value(), !expected.at("pip").is_null());
    if (metadata.picture_in_picture) {
      const json& pip = expected.at("pip");
      EXPECT_DOUBLE_EQ(metadata.picture_in_picture->real_to_ir, pip.at("Real2IR").get<double>());
      EXPECT_EQ(metadata.picture_in_picture->offset_x, pip.at("OffsetX").get<int>());
      EXPECT_EQ(metadata.picture_in_picture->offset_y, pip.at("OffsetY").get<int>());
      EXPECT_EQ(metadata.picture_in_picture->x2, pip.at("X2").get<int>());
      EXPECT_EQ(metadata.picture_in_picture->y2, pip.at("Y2").get<int>());
    }
    ASSERT_EQ(metadata.visible.has_value(), !expected.at("embedded").is_null());
    if (!metadata.visible) continue;
    EXPECT_EQ(metadata.visible->encoding == EmbeddedPicture::Encoding::png ? "PNG" : "JPG",
              expected.at("embedded").at(0).get<std::string>());
    EXPECT_EQ(metadata.visible->width, expected.at("embedded").at(1).get<int>());
    EXPECT_EQ(metadata.visible->height, expected.at("embedded").at(2).get<int>());
    EXPECT_GT(metadata.visible->bytes.size(), 20000U);
  }
}

TEST(RealRadiometricFiles, TellTheCamera) {
  THERMOVOX_NEEDS_RECORDINGS();
  const auto read = [](const char* name) {
    return openThermalRecording(thermalFolder() / name)->read(0).metadata;
  };
  const ThermalMetadata e40 = read("rjpeg/Flir_E40.jpg");
  EXPECT_EQ(e40.make, "FLIR Systems AB");
  EXPECT_EQ(e40.serial, "49033333");
  EXPECT_EQ(e40.lens, "FOL18");
  EXPECT_EQ(e40.time, "2013-04-12T09:24:01.131-01:00");
  EXPECT_NEAR(e40.field_of_view_deg.value(), 25.0, 0.05);
  EXPECT_NEAR(e40.calibrated_range.value().low, -20.0, 0.01);
  EXPECT_NEAR(e40.calibrated_range.value().high, 120.0, 0.01);
  EXPECT_EQ(read("rjpeg/flir_example.jpg").time, "2017-09-08T16:04:36.266+02:00");
  EXPECT_EQ(read("video/SampleCSQ.csq").model, "FLIR T1030sc 12__");
  EXPECT_EQ(read("rjpeg/003.jpg").make, "DJI");
}

TEST(RealThermalTiffs, GiveTheCountsAndTheScaleOfTheReference) {
  THERMOVOX_NEEDS_RECORDINGS();
  const json files = reference("tlinear_tiff");
  for (const auto& [name, expected] : files.items()) {
    SCOPED_TRACE(name);
    const auto recording = openThermalRecording(thermalFolder() / name);
    EXPECT_EQ(recording->frames(), expected.at("pages").get<int>());
    const RawThermalImage image = recording->read(0);
    expectCounts(image, expected);
    const json& gain = expected.at("xmp_tlinear_gain");
    if (gain == 0.0) {
      EXPECT_THAT(std::get<NotTemperature>(image.rule).reason, HasSubstr("TlinearGain is 0"));
      continue;
    }
    const std::string key = name.find("Altum") != std::string::npos ? "C_if_0.01K" : "C_if_0.04K";
    EXPECT_EQ(image.rule_source, gain.is_null() ? RuleSource::model : RuleSource::file);
    const ThermalStatistics celsius = statisticsOf(CelsiusDecoder().decode(image, name), std::nullopt);
    EXPECT_NEAR(celsius.min.value(), expected.at(key).at(0).get<double>(), 0.006);
    EXPECT_NEAR(celsius.max.value(), expected.at(key).at(1).get<double>(), 0.006);
    EXPECT_NEAR(celsius.mean.value(), expected.at(key).at(2).get<double>(), 0.006);
  }
}

TEST(RealThermalTiffs, TellTheOffsetOfAThermoMapByItsName) {
  THERMOVOX_NEEDS_RECORDINGS();
  const RawThermalImage image =
      openThermalRecording(thermalFolder() / "tiff/Sensefly_Thermomap_9mm.tif")->read(0);
  const ThermalStatistics celsius = statisticsOf(CelsiusDecoder().decode(image, "thermoMAP"), std::nullopt);
  EXPECT_NEAR(celsius.min.value(), 15.58, 0.01);  // counts 11558 to 13712
  EXPECT_NEAR(celsius.max.value(), 37.12, 0.01);
}

TEST(RealThermalTiffs, TellTheLensOfAnAltum) {
  THERMOVOX_NEEDS_RECORDINGS();
  const XmpFacts xmp =
      openThermalRecording(thermalFolder() / "tiff/MicaSense_Altum_TRM.tif")->read(0).metadata.xmp;
  EXPECT_DOUBLE_EQ(xmp.focal_length_mm.value(), 2.013042);
  EXPECT_THAT(xmp.principal_point_mm, testing::ElementsAre(0.996829, 0.729053));
  ASSERT_EQ(xmp.perspective_distortion.size(), 5U);
  EXPECT_NEAR(xmp.perspective_distortion[0], -0.36145, 1e-5);
  EXPECT_NEAR(xmp.perspective_distortion[4], 0.00053682, 1e-8);
  const XmpFacts duo =
      openThermalRecording(thermalFolder() / "tiff/FLIR_DUO_PRO_640_R_13mm.TIFF")->read(0).metadata.xmp;
  EXPECT_DOUBLE_EQ(duo.yaw_deg.value(), 163.19) << "written as a ratio";
}

/// What is said of a file that holds no temperatures.
std::string reasonAgainst(const std::string& name) {
  return messageOf<DataError>([&] {
    const auto file = thermalFolder() / "negative" / name;
    static_cast<void>(CelsiusDecoder().decode(openThermalRecording(file)->read(0), file.string()));
  });
}

TEST(RealFilesWithoutTemperatures, AreRefusedWithTheReason) {
  THERMOVOX_NEEDS_RECORDINGS();
  EXPECT_THAT(reasonAgainst("FLIR_Vue_Pro_640.jpg"),
              AllOf(HasSubstr("FLIR_Vue_Pro_640.jpg: is of a Vue Pro 640"), HasSubstr("no temperatures")));
  EXPECT_THAT(reasonAgainst("exif-js-issue-124.tiff"), HasSubstr("TlinearGain is 0"));
  EXPECT_THAT(reasonAgainst("FLIR_no_fff.jpg"),
              AllOf(HasSubstr("FLIR Systems AB"), HasSubstr("without radiometric data")));
  EXPECT_THAT(reasonAgainst("FLIR_placeholder_8x8.jpg"),
              AllOf(HasSubstr("8 x 8"), HasSubstr("3 channel(s) of 8 bits")));
  EXPECT_THAT(reasonAgainst("baboons.jpg"), HasSubstr("without radiometric data"));
}

}  // namespace
}  // namespace thermovox
