#include "io/las_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <random>

#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using testing::Each;

/// A number at an offset of the specification.
template <typename T>
T at(const std::string& bytes, std::size_t offset) {
  static_assert(std::endian::native == std::endian::little);
  T number;
  if (offset + sizeof(T) > bytes.size()) throw std::out_of_range("the file ends before this field");
  std::memcpy(&number, bytes.data() + offset, sizeof(T));
  return number;
}

/// A text of fixed length without the zeros behind it.
std::string textAt(const std::string& bytes, std::size_t offset, std::size_t length) {
  return std::string(bytes, offset, length).c_str();
}

constexpr std::size_t kHeader = 375, kRecord = 54, kField = 192, kPoint = 56;

class LasWriter : public testing::Test {
 protected:
  std::string written(const std::vector<SurfacePoint>& points, const ColourScale& scale = kScale) const {
    writeLas(folder_ / "map.las", points, scale, Existing::replace);
    return test::bytesOf(folder_ / "map.las");
  }

  static inline const ColourScale kScale{Palette::grey, TemperatureSpan{20.0, 100.0}};
  static inline const std::vector<SurfacePoint> kPoints{
      {{1.5F, -2.25F, 3.125F}, SurfaceTemperature{20.5F, 0.25F, 7, 1700000000.25}},
      {{4.0F, 5.0F, 6.0F}, std::nullopt},
      {{11.0F, 8.0F, 9.5F}, SurfaceTemperature{90.0F, 0.5F, 1, 1700000001.5}}};
  test::TestFolder folder_;
};

TEST_F(LasWriter, HeaderSaysWhatTheSpecificationWantsAtItsOffsets) {
  const std::string bytes = written(kPoints);
  EXPECT_EQ(bytes.substr(0, 4), "LASF");
  EXPECT_EQ(at<std::uint16_t>(bytes, 6), 16);  // global encoding: the coordinate system is well-known text
  EXPECT_EQ(at<std::uint8_t>(bytes, 24), 1);
  EXPECT_EQ(at<std::uint8_t>(bytes, 25), 4);
  EXPECT_EQ(textAt(bytes, 26, 32), "OTHER");
  EXPECT_EQ(textAt(bytes, 58, 32), "thermovox");
  EXPECT_EQ(at<std::uint32_t>(bytes, 90), 0U);  // day and year of creation
  EXPECT_EQ(at<std::uint16_t>(bytes, 94), kHeader);
  EXPECT_EQ(at<std::uint32_t>(bytes, 100), 2U);  // variable length records
  EXPECT_EQ(at<std::uint8_t>(bytes, 104), 7);
  EXPECT_EQ(at<std::uint16_t>(bytes, 105), kPoint);
  EXPECT_THAT(bytes.substr(107, 24), Each('\0'));  // counts of older versions
  EXPECT_THAT(bytes.substr(227, 20), Each('\0'));  // waveforms, extended records
  EXPECT_EQ(at<std::uint64_t>(bytes, 247), 3U);
  EXPECT_EQ(at<std::uint64_t>(bytes, 255), 3U);  // first returns
  EXPECT_THAT(bytes.substr(263, 14 * 8), Each('\0'));
  EXPECT_EQ(bytes.size(), at<std::uint32_t>(bytes, 96) + 3 * kPoint);
}

TEST_F(LasWriter, BoundsScaleAndOffsetFitThePoints) {
  const std::string bytes = written(kPoints);
  const Eigen::Vector3d high(11.0, 8.0, 9.5), low(1.5, -2.25, 3.125);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(at<double>(bytes, 131 + 8 * axis), 1e-4);
    EXPECT_EQ(at<double>(bytes, 155 + 8 * axis), (axis == 0 ? 6.0 : (axis == 1 ? 3.0 : 6.0)));
    EXPECT_NEAR(at<double>(bytes, 179 + 16 * axis), high[static_cast<int>(axis)], 1e-9);
    EXPECT_NEAR(at<double>(bytes, 187 + 16 * axis), low[static_cast<int>(axis)], 1e-9);
  }
}

TEST_F(LasWriter, ExtraBytesAreDescribed) {
  const std::string bytes = written(kPoints);
  EXPECT_EQ(textAt(bytes, kHeader + 2, 16), "LASF_Spec");
  EXPECT_EQ(at<std::uint16_t>(bytes, kHeader + 18), 4);
  EXPECT_EQ(at<std::uint16_t>(bytes, kHeader + 20), 4 * kField);
  struct Expected {
    std::string name;
    int type;
    bool may_lack;
  };
  const std::vector<Expected> fields{
      {"temperature", 9, true}, {"temperature_sigma", 9, true}, {"count", 5, false}, {"time", 10, true}};
  for (std::size_t i = 0; i < fields.size(); ++i) {
    SCOPED_TRACE(fields[i].name);
    const std::string field = bytes.substr(kHeader + kRecord + i * kField, kField);
    EXPECT_EQ(textAt(field, 4, 32), fields[i].name);
    EXPECT_EQ(at<std::uint8_t>(field, 2), fields[i].type);
    EXPECT_EQ(at<std::uint8_t>(field, 3), fields[i].may_lack ? 1 : 0);
    EXPECT_EQ(std::isnan(at<double>(field, 40)), fields[i].may_lack);  // "no data"
    EXPECT_THAT(field.substr(48, 112), Each('\0'));
    EXPECT_FALSE(textAt(field, 160, 32).empty());
  }
}

TEST_F(LasWriter, CoordinateSystemIsALocalOneInMetres) {
  const std::string bytes = written(kPoints);
  const std::size_t record = kHeader + kRecord + 4 * kField;
  EXPECT_EQ(textAt(bytes, record + 2, 16), "LASF_Projection");
  EXPECT_EQ(at<std::uint16_t>(bytes, record + 18), 2112);
  const auto length = at<std::uint16_t>(bytes, record + 20);
  EXPECT_EQ(at<std::uint32_t>(bytes, 96), record + kRecord + length);
  const std::string text = bytes.substr(record + kRecord, length);
  EXPECT_THAT(text, testing::StartsWith("LOCAL_CS["));
  EXPECT_THAT(text, testing::HasSubstr("UNIT[\"metre\",1]"));
  EXPECT_EQ(text.find('\0'), length - 1U);
  EXPECT_EQ(std::count(text.begin(), text.end(), '['), std::count(text.begin(), text.end(), ']'));
}

TEST_F(LasWriter, PointsHoldPlaceColourAndTemperature) {
  const std::string bytes = written(kPoints);
  const std::string first = bytes.substr(at<std::uint32_t>(bytes, 96), kPoint);
  EXPECT_EQ(at<std::int32_t>(first, 0), -45000);  // (1.5 - 6) / 1e-4
  EXPECT_EQ(at<std::int32_t>(first, 4), -52500);
  EXPECT_EQ(at<std::int32_t>(first, 8), -28750);
  EXPECT_EQ(at<std::uint16_t>(first, 12), 1 + 410);  // 0.5 of 80 C, of 65534
  EXPECT_EQ(at<std::uint8_t>(first, 14), 0x11);      // return 1 of 1
  EXPECT_THAT(first.substr(15, 15), Each('\0'));     // flags, class, user data, angle, source, GPS time
  const Rgb colour = colourOf(20.5, *kScale.span, kScale.palette);
  EXPECT_EQ(at<std::uint16_t>(first, 30), colour.r * 257);
  EXPECT_EQ(at<std::uint16_t>(first, 34), colour.b * 257);
  EXPECT_EQ(at<float>(first, 36), 20.5F);
  EXPECT_EQ(at<float>(first, 40), 0.25F);
  EXPECT_EQ(at<std::uint32_t>(first, 44), 7U);
  EXPECT_EQ(at<double>(first, 48), 1700000000.25);
}

TEST_F(LasWriter, WhatNoFrameSawHasNoTemperature) {
  const std::string bytes = written(kPoints);
  const std::string second = bytes.substr(at<std::uint32_t>(bytes, 96) + kPoint, kPoint);
  EXPECT_EQ(at<std::uint16_t>(second, 12), 0);
  EXPECT_EQ(at<std::uint16_t>(second, 30), 128 * 257);
  EXPECT_TRUE(std::isnan(at<float>(second, 36)));
  EXPECT_TRUE(std::isnan(at<float>(second, 40)));
  EXPECT_EQ(at<std::uint32_t>(second, 44), 0U);
  EXPECT_TRUE(std::isnan(at<double>(second, 48)));
}

TEST_F(LasWriter, IntensityEndsAtTheEndsOfTheSpan) {
  std::vector<SurfacePoint> points;
  for (const float celsius : {-40.0F, 20.0F, 60.0F, 100.0F, 500.0F}) {
    points.push_back({{0, 0, 0}, SurfaceTemperature{celsius, 0.1F, 1, 0.0}});
  }
  const std::string bytes = written(points);
  std::vector<int> intensities;
  for (std::size_t i = 0; i < points.size(); ++i) {
    intensities.push_back(at<std::uint16_t>(bytes, at<std::uint32_t>(bytes, 96) + i * kPoint + 12));
  }
  EXPECT_THAT(intensities, testing::ElementsAre(1, 1, 32768, 65535, 65535));
}

TEST_F(LasWriter, KeepsPlacesToATenthOfAMillimetre) {
  std::mt19937 rng(3);
  for (const auto& [reach, step] : {std::pair(50.0F, 1e-4), std::pair(1e6F, 1e-3)}) {
    std::uniform_real_distribution<float> coordinate(-reach, reach);
    std::vector<SurfacePoint> points{{{-reach, -reach, -reach}, {}}, {{reach, reach, reach}, {}}};
    while (points.size() < 500) points.push_back({{coordinate(rng), coordinate(rng), coordinate(rng)}, {}});
    const std::string bytes = written(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto steps = at<std::int32_t>(bytes, at<std::uint32_t>(bytes, 96) + i * kPoint + 4 * axis);
        const double read = steps * at<double>(bytes, 131 + 8 * axis) + at<double>(bytes, 155 + 8 * axis);
        ASSERT_NEAR(read, points[i].p_world[static_cast<int>(axis)], 0.5001 * step);
        ASSERT_LE(read, at<double>(bytes, 179 + 16 * axis));
        ASSERT_GE(read, at<double>(bytes, 187 + 16 * axis));
      }
    }
  }
}

TEST_F(LasWriter, WritesEmptyCloudsAndTheSameBytesTwice) {
  const std::string empty = written({});
  EXPECT_EQ(empty.size(), at<std::uint32_t>(empty, 96));
  EXPECT_EQ(at<std::uint64_t>(empty, 247), 0U);
  EXPECT_EQ(written(kPoints), written(kPoints));
}

TEST_F(LasWriter, RefusesAFileThatIsThere) {
  folder_.write("map.las", "mine");
  EXPECT_THROW(writeLas(folder_ / "map.las", kPoints, kScale, Existing::refuse), DataError);
  EXPECT_EQ(test::bytesOf(folder_ / "map.las"), "mine");
}

}  // namespace
}  // namespace thermovox
