#include "io/visible_frames.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "projection/error.hpp"
#include "tests/projection/random_cameras.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox::test {
namespace {

using std::chrono::milliseconds;

/// Pictures at 1, 2 and 4 s, of brightness 10, 20 and 40.
class VisibleFramesTest : public testing::Test {
 protected:
  VisibleFramesTest() {
    for (const int second : {1, 2, 4}) {
      cv::imwrite((folder / (std::to_string(second) + ".png")).string(),
                  cv::Mat(6, 8, CV_8U, cv::Scalar(10 * second)));
    }
    folder.write("visible.csv", "timestamp,file\n1,1.png\n2,2.png\n4,4.png\n");
  }
  [[nodiscard]] VisibleFrames open() const {
    return {folder / "visible.csv", folder.path(), Camera(intrinsicsOf(LensModel::pinhole, {}, 8, 6))};
  }
  static Time at(int ms) { return Time(milliseconds(ms)); }

  TestFolder folder;
};

TEST_F(VisibleFramesTest, TheNearestInTimeIsRead) {
  VisibleFrames frames = open();
  for (const auto& [ms, brightness] :
       {std::pair(100, 10), {1400, 10}, {1600, 20}, {2000, 20}, {2900, 20}, {3100, 40}, {4900, 40}}) {
    const auto frame = frames.nearest(at(ms), milliseconds(1000));
    ASSERT_TRUE(frame) << ms;
    EXPECT_EQ(frame->picture.luminance.front(), brightness) << ms;
    EXPECT_EQ(frame->stamp, at(100 * brightness)) << ms;
  }
}

TEST_F(VisibleFramesTest, NoneIsTooFarAway) {
  VisibleFrames frames = open();
  EXPECT_FALSE(frames.nearest(at(700), milliseconds(200)));
  EXPECT_TRUE(frames.nearest(at(1150), milliseconds(200)));
  EXPECT_FALSE(frames.nearest(at(3000), milliseconds(200)));
  EXPECT_FALSE(frames.nearest(at(4201), milliseconds(200)));
}

TEST_F(VisibleFramesTest, WhatIsMissingIsNamedWithItsRow) {
  folder.write("visible.csv", "1,1.png\n2,none.png\n");
  VisibleFrames frames = open();
  EXPECT_TRUE(frames.nearest(at(1000), milliseconds(10)));
  EXPECT_THAT(messageOf<DataError>([&] { static_cast<void>(frames.nearest(at(2000), milliseconds(10))); }),
              testing::AllOf(testing::HasSubstr("none.png"), testing::HasSubstr("visible.csv:2")));
}

}  // namespace
}  // namespace thermovox::test
