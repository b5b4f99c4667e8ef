#include "io/flir_camera_info.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "io/byte_order.hpp"
#include "projection/celsius_table.hpp"

namespace thermovox {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::size_t kWhole = 2476;  // bytes, as of a FLIR E40

/// A record of the camera, as an E40 writes it, in either byte order.
class CameraRecord {
 public:
  explicit CameraRecord(ByteOrder order = ByteOrder::little) : order_(order), bytes_(kWhole, '\0') {
    put(0x00, std::uint16_t{2});
    const std::pair<std::size_t, float> numbers[] = {
        {0x20, 0.93F},   {0x24, 4.5F},    {0x28, 291.15F},    {0x2C, 293.15F},  {0x30, 295.15F},
        {0x34, 0.88F},   {0x3C, 0.4F},    {0x58, 14259.625F}, {0x5C, 1383.2F},  {0x60, 1.5F},
        {0x70, 0.0065F}, {0x74, 0.0126F}, {0x78, -0.0022F},   {0x7C, -0.0066F}, {0x80, 1.8F},
        {0x90, 393.15F}, {0x94, 253.15F}, {0x1B4, 25.0F},     {0x30C, 0.01098F}};
    for (const auto& [offset, number] : numbers) put(offset, number);
    put(0x308, std::int32_t{-5667});
    text(0xD4, "FLIR E40");
    text(0x104, "64502173");
    text(0x114, "1.2.3");
    text(0x170, "FOL18");
    put(0x384, std::uint32_t{1365762241});  // 2013-04-12 10:24:01 UTC
    put(0x388, std::uint32_t{131});
    put(0x38C, std::int16_t{-120});
  }

  template <typename Number>
  CameraRecord& put(std::size_t offset, Number number) {
    std::uint32_t bits = 0;
    if constexpr (std::is_same_v<Number, float>) {
      bits = std::bit_cast<std::uint32_t>(number);
    } else {
      bits = static_cast<std::uint32_t>(number);
    }
    for (std::size_t i = 0; i < sizeof(Number); ++i)
      bytes_[offset + (order_ == ByteOrder::little ? i : sizeof(Number) - 1 - i)] =
          static_cast<char>(bits >> 8 * i);
    return *this;
  }
  CameraRecord& text(std::size_t offset, const std::string& characters) {
    bytes_.replace(offset, characters.size(), characters);
    return *this;
  }

  [[nodiscard]] FlirCameraInfo info(std::size_t size = kWhole) const {
    return parseFlirCameraInfo(std::as_bytes(std::span(bytes_)).first(size));
  }
  [[nodiscard]] RadiometricParameters parameters() const { return info().parameters.value(); }

 private:
  ByteOrder order_;
  std::string bytes_;
};

class CameraInfoOfEitherOrder : public testing::TestWithParam<ByteOrder> {};

TEST_P(CameraInfoOfEitherOrder, IsReadFieldByField) {
  const FlirCameraInfo info = CameraRecord(GetParam()).info();
  ASSERT_TRUE(info.parameters);
  const RadiometricParameters& p = *info.parameters;
  EXPECT_FLOAT_EQ(static_cast<float>(p.planck.r1), 14259.625F);
  EXPECT_FLOAT_EQ(static_cast<float>(p.planck.r2), 0.01098F);
  EXPECT_FLOAT_EQ(static_cast<float>(p.planck.b), 1383.2F);
  EXPECT_EQ(p.planck.f, 1.5);
  EXPECT_EQ(p.planck.o, -5667.0);
  EXPECT_FLOAT_EQ(static_cast<float>(p.emissivity), 0.93F);
  EXPECT_EQ(p.distance, 4.5);
  EXPECT_NEAR(p.reflected, 18.0, 1e-4);
  EXPECT_NEAR(p.atmosphere_temperature, 20.0, 1e-4);
  EXPECT_NEAR(p.window_temperature, 22.0, 1e-4);
  EXPECT_FLOAT_EQ(static_cast<float>(p.window_transmission), 0.88F);
  EXPECT_FLOAT_EQ(static_cast<float>(p.humidity), 0.4F);
  EXPECT_FLOAT_EQ(static_cast<float>(p.atmosphere.beta2), -0.0066F);
  EXPECT_FLOAT_EQ(static_cast<float>(p.atmosphere.x), 1.8F);
  EXPECT_EQ(info.metadata.model, "FLIR E40");
  EXPECT_EQ(info.metadata.serial, "64502173");
  EXPECT_EQ(info.metadata.software, "1.2.3");
  EXPECT_EQ(info.metadata.lens, "FOL18");
  EXPECT_EQ(info.metadata.field_of_view_deg, 25.0);
  EXPECT_NEAR(info.metadata.calibrated_range.value().low, -20.0, 1e-4);
  EXPECT_NEAR(info.metadata.calibrated_range.value().high, 120.0, 1e-4);
  EXPECT_EQ(info.metadata.time, "2013-04-12T12:24:01.131+02:00");
}

TEST_P(CameraInfoOfEitherOrder, TellsOfAShorterRecordWhatIsWhollyThere) {
  const CameraRecord record(GetParam());
  for (std::size_t size = 0; size <= kWhole; ++size) {
    SCOPED_TRACE(size);
    const FlirCameraInfo info = record.info(size);
    EXPECT_EQ(info.parameters.has_value(), size >= 0x310) << "the last of Planck's constants";
    EXPECT_EQ(info.metadata.calibrated_range.has_value(), size >= 0x98);
    EXPECT_EQ(info.metadata.field_of_view_deg.has_value(), size >= 0x1B8);
    EXPECT_EQ(info.metadata.time.empty(), size < 0x38E);
    EXPECT_TRUE(std::string("FLIR E40").starts_with(info.metadata.model));
  }
}

INSTANTIATE_TEST_SUITE_P(Both, CameraInfoOfEitherOrder, testing::Values(ByteOrder::little, ByteOrder::big),
                         [](const auto& test) { return test.param == ByteOrder::little ? "little" : "big"; });

TEST(FlirCameraInfo, HasNoParametersWithoutUsablePlanckConstants) {
  for (const std::size_t offset : {0x58U, 0x5CU, 0x30CU}) {
    for (const float impossible : {0.0F, -1.0F, kNaN, kInfinity})
      EXPECT_FALSE(CameraRecord().put(offset, impossible).info().parameters) << offset << ": " << impossible;
  }
  EXPECT_FALSE(CameraRecord().put(0x60, kNaN).info().parameters);
  EXPECT_TRUE(CameraRecord().put(0x60, 0.0F).info().parameters) << "F may be anything finite";
}

TEST(FlirCameraInfo, HoldsSharesToWhatCanBe) {
  const auto emissivity = [](float stored) {
    return CameraRecord().put(0x20, stored).parameters().emissivity;
  };
  EXPECT_EQ(emissivity(0.0F), 0.95) << "not written on purpose";
  EXPECT_EQ(emissivity(-0.5F), 0.95);
  EXPECT_EQ(emissivity(kNaN), 0.95);
  EXPECT_EQ(emissivity(0.01F), 0.05);
  EXPECT_EQ(emissivity(1.0F), 1.0);
  EXPECT_EQ(emissivity(7.0F), 1.0);
  EXPECT_EQ(CameraRecord().put(0x34, 0.0F).parameters().window_transmission, 1.0);
}

TEST(FlirCameraInfo, TakesHumidityAboveTwoForPercent) {
  const auto humidity = [](float stored) { return CameraRecord().put(0x3C, stored).parameters().humidity; };
  EXPECT_EQ(humidity(0.0F), 0.0);
  EXPECT_EQ(humidity(0.5F), 0.5);
  EXPECT_EQ(humidity(2.0F), 1.0) << "200 % at most";
  EXPECT_EQ(humidity(50.0F), 0.5);
  EXPECT_EQ(humidity(250.0F), 1.0);
  EXPECT_EQ(humidity(-0.1F), 0.5) << "the usual one";
  EXPECT_EQ(humidity(kInfinity), 0.5);
}

TEST(FlirCameraInfo, TakesTheUsualTemperatureForOneThatCannotBe) {
  for (const float kelvin : {0.0F, -20.0F, 10000.0F, kNaN, kInfinity}) {
    EXPECT_EQ(CameraRecord().put(0x28, kelvin).parameters().reflected, 20.0) << kelvin;
    EXPECT_EQ(CameraRecord().put(0x2C, kelvin).parameters().atmosphere_temperature, 20.0) << kelvin;
    EXPECT_EQ(CameraRecord().put(0x30, kelvin).parameters().window_temperature, 20.0) << kelvin;
    EXPECT_FALSE(CameraRecord().put(0x90, kelvin).info().metadata.calibrated_range) << kelvin;
  }
  EXPECT_FALSE(CameraRecord().put(0x90, 253.15F).info().metadata.calibrated_range) << "a range of nothing";
}

TEST(FlirCameraInfo, TakesTheUsualDistanceForOneThatCannotBe) {
  for (const float metres : {-1.0F, kNaN, kInfinity})
    EXPECT_EQ(CameraRecord().put(0x24, metres).parameters().distance, 1.0);
  EXPECT_EQ(CameraRecord().put(0x24, 0.0F).parameters().distance, 0.0);
}

TEST(FlirCameraInfo, TakesTheUsualAirForOneOfZerosOrHalfDamaged) {
  CameraRecord zeros;
  for (const std::size_t offset : {0x70U, 0x74U, 0x78U, 0x7CU, 0x80U}) zeros.put(offset, 0.0F);
  EXPECT_EQ(zeros.parameters().atmosphere, AtmosphereConstants{});
  EXPECT_EQ(CameraRecord().put(0x7C, kNaN).parameters().atmosphere, AtmosphereConstants{});
}

TEST(FlirCameraInfo, GivesParametersThatCanBeWorkedWithWhateverTheRecordHolds) {
  for (const float number : {0.0F, -1.0F, 1e-30F, 1e30F, kNaN, kInfinity}) {
    CameraRecord record;
    for (std::size_t offset = 0x20; offset <= 0x3C; offset += 4) record.put(offset, number);
    EXPECT_NO_THROW(record.parameters().validate()) << number;
  }
}

TEST(FlirCameraInfo, TellsTheTimeInTheZoneOfTheCamera) {
  const auto time = [](std::int16_t minutes_behind) {
    return CameraRecord().put(0x38C, minutes_behind).info().metadata.time;
  };
  EXPECT_EQ(time(0), "2013-04-12T10:24:01.131+00:00");
  EXPECT_EQ(time(300), "2013-04-12T05:24:01.131-05:00");
  EXPECT_EQ(time(-345), "2013-04-12T16:09:01.131+05:45");
  EXPECT_EQ(time(24 * 60 + 1), "") << "no zone is that far away";
  EXPECT_EQ(CameraRecord().put(0x384, std::uint32_t{0}).info().metadata.time, "");
  EXPECT_EQ(
      CameraRecord().put(0x384, std::uint32_t{0xFFFFFFFF}).put(0x38C, std::int16_t{0}).info().metadata.time,
      "2106-02-07T06:28:15.131+00:00");
}

TEST(FlirCameraInfo, LeavesOutOfItsTextsWhatIsNoText) {
  const FlirCameraInfo info = CameraRecord()
                                  .text(0xD4, "FLIR\x01 E40\xFF  " + std::string(1, '\0') + "rest")
                                  .text(0x170, std::string(40, 'L'))
                                  .info();
  EXPECT_EQ(info.metadata.model, "FLIR E40");
  EXPECT_EQ(info.metadata.lens, std::string(32, 'L')) << "a field without its end";
}

}  // namespace
}  // namespace thermovox
