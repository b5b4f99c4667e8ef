#include "io/pose_text.hpp"

#include <gtest/gtest.h>

#include <random>

namespace thermovox {
namespace {

TEST(PoseText, ReadsBackExactly) {
  std::mt19937_64 rng(5);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 100; ++i) {
    const Pose pose{
        Eigen::Quaterniond(normal(rng), normal(rng), normal(rng), normal(rng)).normalized().normalized(),
        {normal(rng), 1e6 * normal(rng), 1e-6 * normal(rng)}};
    const auto read = parsePose(poseText(pose));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->translation, pose.translation);
    EXPECT_LT((read->rotation.coeffs() - pose.rotation.coeffs()).norm(), 1e-15);
    EXPECT_EQ(poseText(*parsePose(poseText(*read))), poseText(*read));
  }
}

TEST(PoseText, TakesBlanksAndLineEnds) {
  EXPECT_EQ(parsePose(" 1 2\t3\r\n0 0 0 1\n"), (Pose{Eigen::Quaterniond::Identity(), {1, 2, 3}}));
}

TEST(PoseText, RefusesAnythingElse) {
  for (const char* text : {"", "1 2 3", "1 2 3 0 0 0 1 4", "1 2 x 0 0 0 1", "nan 0 0 0 0 0 1",
                           "0 0 0 0 0 0 2", "0 0 0 0 0 0 0", "1,2,3,0,0,0,1"})
    EXPECT_FALSE(parsePose(text)) << text;
}

}  // namespace
}  // namespace thermovox
