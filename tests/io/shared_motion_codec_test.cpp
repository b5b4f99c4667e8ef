#include "io/shared_motion_codec.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <random>

#include "projection/error.hpp"
#include "tests/io/stations.hpp"

namespace thermovox {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

std::vector<SharedMotion> someMotions() {
  std::mt19937 random(8);
  std::normal_distribution<float> normal;
  std::vector<SharedMotion> motions(5);
  for (SharedMotion& motion : motions) {
    motion.cube = {static_cast<std::int32_t>(random()), -3, 7};
    motion.laser = 1;
    motion.count = static_cast<std::uint32_t>(random()) | 1U;
    motion.by_rotation = Eigen::Matrix3f::NullaryExpr([&] { return normal(random); });
    motion.by_translation = Eigen::Matrix3f::NullaryExpr([&] { return normal(random); });
    motion.by_range = Eigen::Vector3f::NullaryExpr([&] { return normal(random); });
    motion.lever = Eigen::Vector3f::NullaryExpr([&] { return 1e3F * normal(random); });
    motion.view = Eigen::Vector3f::NullaryExpr([&] { return normal(random); });
  }
  return motions;
}

std::string refusal(const std::string& bytes) {
  return test::messageOf<DataError>([&] { (void)decodeSharedMotions(bytes); });
}

TEST(SharedMotionCodec, ReadsWhatItWroteToTheBit) {
  const std::vector<SharedMotion> motions = someMotions();
  const std::string bytes = encodeSharedMotions(motions);
  EXPECT_EQ(bytes.size(), 5U * 128U);
  const std::vector<SharedMotion> read = decodeSharedMotions(bytes);
  ASSERT_EQ(read.size(), motions.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].cube, motions[i].cube);
    EXPECT_EQ(read[i].laser, motions[i].laser);
    EXPECT_EQ(read[i].count, motions[i].count);
    EXPECT_EQ(read[i].by_rotation, motions[i].by_rotation);
    EXPECT_EQ(read[i].by_translation, motions[i].by_translation);
    EXPECT_EQ(read[i].by_range, motions[i].by_range);
    EXPECT_EQ(read[i].lever, motions[i].lever);
    EXPECT_EQ(read[i].view, motions[i].view);
  }
  EXPECT_EQ(encodeSharedMotions(read), bytes);
  EXPECT_THAT(decodeSharedMotions(""), IsEmpty());
}

TEST(SharedMotionCodec, KeepsItsLayout) {
  SharedMotion motion;
  motion.cube = {1, -2, 3};
  motion.laser = 4;
  motion.count = 5;
  motion.by_rotation(0, 1) = 1.0F;
  motion.view.z() = -2.0F;
  const std::string bytes = encodeSharedMotions({motion});
  ASSERT_EQ(bytes.size(), 128U);
  EXPECT_EQ(bytes.substr(0, 20), std::string("\1\0\0\0\xFE\xFF\xFF\xFF\3\0\0\0\4\0\0\0\5\0\0\0", 20));
  EXPECT_EQ(bytes.substr(24, 4), std::string("\0\0\x80\x3F", 4));  // row by row
  EXPECT_EQ(bytes.substr(124, 4), std::string("\0\0\0\xC0", 4));
}

TEST(SharedMotionCodec, RefusesWhatNoMissionHas) {
  const std::string bytes = encodeSharedMotions(someMotions());
  for (const std::size_t size : {std::size_t{1}, std::size_t{127}, bytes.size() - 1}) {
    EXPECT_THAT(refusal(bytes.substr(0, size)), HasSubstr("expected a multiple of 128"));
  }
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    std::vector<SharedMotion> motions = someMotions();
    motions[3].lever.y() = bad;
    EXPECT_THAT(refusal(encodeSharedMotions(motions)), HasSubstr("not finite"));
  }
  std::vector<SharedMotion> motions = someMotions();
  motions[1].count = 0;
  EXPECT_THAT(refusal(encodeSharedMotions(motions)), HasSubstr("means of no returns"));
}

}  // namespace
}  // namespace thermovox
