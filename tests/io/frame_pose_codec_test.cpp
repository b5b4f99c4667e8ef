#include "io/frame_pose_codec.hpp"

#include <gmock/gmock.h>

#include "projection/error.hpp"
#include "tests/io/stations.hpp"

namespace thermovox {
namespace {

using testing::HasSubstr;

std::vector<FramePose> someFrames() {
  return {{Time(Duration(-5)), {}},
          {Time(Duration(1'700'000'000'123'456'789)), {expRotation({0.3, -1.0, 2.0}), {1e5, -2.5, 0.125}}}};
}

std::string refusal(const std::string& bytes) {
  return test::messageOf<DataError>([&] { (void)decodeFramePoses(bytes); });
}

TEST(FramePoseCodec, ReadsWhatItWroteToTheBit) {
  const std::vector<FramePose> frames = someFrames();
  const std::string bytes = encodeFramePoses(frames);
  EXPECT_EQ(bytes.size(), 128U);
  const std::vector<FramePose> read = decodeFramePoses(bytes);
  ASSERT_EQ(read.size(), 2U);
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].stamp, frames[i].stamp);
    EXPECT_EQ(read[i].T_world_camera, frames[i].T_world_camera);
  }
  EXPECT_EQ(encodeFramePoses(read), bytes);
  EXPECT_THAT(decodeFramePoses(""), testing::IsEmpty());
}

TEST(FramePoseCodec, RefusesWhatIsNoPose) {
  EXPECT_THAT(refusal(encodeFramePoses(someFrames()).substr(0, 100)), HasSubstr("expected a multiple of 64"));
  std::vector<FramePose> frames = someFrames();
  frames[1].T_world_camera.rotation.coeffs() *= 1.01;
  EXPECT_THAT(refusal(encodeFramePoses(frames)), HasSubstr("a pose that is none"));
  frames = someFrames();
  frames[0].T_world_camera.translation.x() = std::nan("");
  EXPECT_THAT(refusal(encodeFramePoses(frames)), HasSubstr("a pose that is none"));
}

}  // namespace
}  // namespace thermovox
