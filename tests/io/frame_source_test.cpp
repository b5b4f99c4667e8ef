#include "io/frame_source.hpp"

#include <gmock/gmock.h>

#include "projection/error.hpp"
#include "tests/io/flir_file.hpp"
#include "tests/io/tiff_writer.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using test::FlirFile;
using testing::AllOf;
using testing::HasSubstr;

constexpr int kWidth = 20;
constexpr int kHeight = 15;

/// Of the test's images; its counts are tenths of a degree.
ThermalCamera smallCamera() {
  Intrinsics intrinsics{.width_px = kWidth, .height_px = kHeight};
  intrinsics.parameters[kFx] = intrinsics.parameters[kFy] = 20.0;
  return {.camera = Camera(intrinsics), .t_linear = {0.1, 0.0}};
}

FlirFile fileOf(std::uint64_t seed) {
  return {.width = kWidth,
          .height = kHeight,
          .counts = test::calmCounts(kWidth, kHeight, seed),
          .parameters = test::e40()};
}

std::unique_ptr<FrameSource> framesOf(const test::TestFolder& folder, const std::string& list) {
  return readFrames({.list = folder.write("thermal.csv", list), .folder = folder.path()}, smallCamera());
}

TEST(ReadFrames, TakesEveryFormatOfThermalImages) {
  const test::TestFolder folder;
  folder.write("a.jpg", test::radiometricJpeg(flirFrame(fileOf(1))));
  folder.write("b.seq", flirFrame(fileOf(2)) + flirFrame(fileOf(3)));
  writeTiff(folder / "c.tiff", test::TiffPages<std::uint16_t>{kWidth, kHeight, {fileOf(4).counts}});
  writeTiff(folder / "d.tiff",
            test::TiffPages<float>{kWidth, kHeight, {std::vector<float>(kWidth * kHeight, 21.5F)}});
  const auto frames = framesOf(folder, "1,a.jpg\n2,b.seq,1\n3,b.seq,0\n4,c.tiff\n5,d.tiff\n");
  RadiometricParameters no_air = test::e40();
  no_air.distance = 0.0;
  for (const std::uint64_t seed : {1U, 3U, 2U}) {
    const auto frame = frames->next();
    ASSERT_TRUE(frame);
    EXPECT_NEAR(frame->image->at(7, 5), celsiusOfCounts(fileOf(seed).counts[5 * kWidth + 7], no_air), 1e-3);
    ASSERT_NE(frame->image->air, nullptr) << "the point's own distance is still to be put in";
    EXPECT_NEAR(frame->image->air->parameters().planck.r1, no_air.planck.r1, 1e-3);
  }
  const auto counts = frames->next();
  EXPECT_FLOAT_EQ(counts->image->at(7, 5), 0.1F * static_cast<float>(fileOf(4).counts[5 * kWidth + 7]));
  EXPECT_EQ(counts->image->air, nullptr) << "a linear camera has the air in its counts";
  EXPECT_EQ(frames->next()->image->at(7, 5), 21.5F);
  EXPECT_FALSE(frames->next());
}

TEST(ReadFrames, NamesTheFileAndTheFrameThatCannotBeUsed) {
  const test::TestFolder folder;
  folder.write("b.seq", flirFrame(fileOf(2)));
  FlirFile vue = fileOf(1);
  vue.model = "Vue Pro 640";
  folder.write("vue.jpg", test::radiometricJpeg(flirFrame(vue)));
  const auto complaint = [&](const std::string& list) {
    return test::messageOf<DataError>([&] { static_cast<void>(framesOf(folder, list)->next()); });
  };
  EXPECT_THAT(complaint("1,b.seq,4\n"), AllOf(HasSubstr("b.seq: has no frame 4"), HasSubstr("0 to 0")));
  EXPECT_THAT(complaint("1,vue.jpg\n"), AllOf(HasSubstr("vue.jpg: is of a Vue Pro 640")));
  EXPECT_THAT(complaint("1,none.jpg\n"), HasSubstr("thermal.csv:1"));
}

}  // namespace
}  // namespace thermovox
