#include "mapping/best_frame.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thermovox {
namespace {

ThermalCamera camera() {
  Intrinsics in{.width_px = 160, .height_px = 120};
  in.parameters = {150.0, 150.0, 79.5, 59.5};
  return {.camera = Camera(in)};
}

/// A camera that looks along z from a place.
FramePose frameFrom(const Eigen::Vector3d& eye, int second) {
  return {Time(std::chrono::seconds(second)), {Eigen::Quaterniond::Identity(), eye}};
}

Hotspot spotSeenFrom(float range) {
  Hotspot spot;
  spot.position.p_world = {0.3, 0.0, 5.0};
  spot.best_view = {range, std::nanf("")};
  spot.best_seen = spot.position.p_world;
  spot.normal = {0.0, 0.0, -1.0};
  return spot;
}

TEST(FindBestFrame, IsTheOneAsFarAwayAsTheBestView) {
  Hotspot spot = spotSeenFrom(3.0F);
  const std::vector<FramePose> frames{frameFrom({0.3, 0.0, 0.0}, 1), frameFrom({0.3, 0.0, 1.97}, 2),
                                      frameFrom({0.0, 0.0, 2.0149}, 3), frameFrom({0.3, 0.0, 4.0}, 4)};
  findBestFrame(spot, frames, camera(), 0.05);
  ASSERT_TRUE(spot.best_frame);
  EXPECT_EQ(spot.best_frame->stamp, frames[2].stamp);
  EXPECT_NEAR(spot.best_frame->pixel.x(), 79.5 + 150.0 * 0.3 / 2.9851, 1e-9);
  EXPECT_NEAR(spot.best_frame->pixel.y(), 59.5, 1e-9);
  // The incidence is that of this frame, not of one that was nearer at first.
  EXPECT_NEAR(spot.best_view.incidence, std::atan(0.3 / 2.9851), 1e-6);
}

TEST(FindBestFrame, IsTheFrameOfTheCellWithTheBestViewAndThePixelOfThePeak) {
  Hotspot spot = spotSeenFrom(3.0F);
  spot.best_seen = {0.3, 0.5, 5.0};  // of a spot half a metre wide
  const std::vector<FramePose> frames{frameFrom({0.3, 0.0, 2.0}, 1), frameFrom({0.3, 0.5, 2.0}, 2)};
  findBestFrame(spot, frames, camera(), 0.05);
  ASSERT_TRUE(spot.best_frame);
  EXPECT_EQ(spot.best_frame->stamp, frames[1].stamp);
  EXPECT_NEAR(spot.best_frame->pixel.y(), 59.5 - 150.0 * 0.5 / 3.0, 1e-9);
  spot.best_seen = {0.3, 1.5, 5.0};
  findBestFrame(spot, std::vector{frameFrom({0.3, 2.5, 2.172}, 3)}, camera(), 0.05);
  EXPECT_NEAR(spot.best_frame->pixel.y(), 59.5 - 150.0 / 2.828, 0.02) << "the peak is outside: the cell's";
}

TEST(FindBestFrame, KeepsAnIncidenceThatIsKnown) {
  Hotspot spot = spotSeenFrom(3.0F);
  spot.best_view.incidence = 0.7F;
  findBestFrame(spot, std::vector{frameFrom({0.3, 0.0, 2.0}, 1)}, camera(), 0.05);
  EXPECT_TRUE(spot.best_frame);
  EXPECT_EQ(spot.best_view.incidence, 0.7F);
}

TEST(FindBestFrame, LeavesASpotThatNoFrameFits) {
  Hotspot spot = spotSeenFrom(3.0F);
  const std::vector<FramePose> frames{frameFrom({0.3, 0.0, 1.8}, 1),     // too far
                                      frameFrom({0.3, 0.0, 8.0}, 2),     // behind
                                      frameFrom({3.0, 0.0, 3.691}, 3)};  // beside the image
  findBestFrame(spot, frames, camera(), 0.05);
  EXPECT_FALSE(spot.best_frame);
  EXPECT_TRUE(std::isnan(spot.best_view.incidence));
  findBestFrame(spot, {}, camera(), 0.05);
  EXPECT_FALSE(spot.best_frame);
}

TEST(FindBestFrame, WithoutANormalTheIncidenceStaysUnknown) {
  Hotspot spot = spotSeenFrom(3.0F);
  spot.normal.setZero();
  findBestFrame(spot, std::vector{frameFrom({0.3, 0.0, 2.0}, 1)}, camera(), 0.05);
  EXPECT_TRUE(spot.best_frame);
  EXPECT_TRUE(std::isnan(spot.best_view.incidence));
}

}  // namespace
}  // namespace thermovox
