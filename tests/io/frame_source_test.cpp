#include "io/frame_source.hpp"

#include <gmock/gmock.h>

#include "io/thermal_recording.hpp"
#include "io/thermal_tiff_writer.hpp"
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
  return {.camera = Camera(intrinsics), .t_linear = TLinear{0.1, 0.0}};
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

TEST(OpenThermalRecording, LeavesTheVisiblePictureOutOnRequestInEveryFormatThatHasOne) {
  const test::TestFolder folder;
  FlirFile file = fileOf(1);
  file.visible_jpeg = "\xFF\xD8\xFF\xD9";
  folder.write("a.jpg", test::radiometricJpeg(flirFrame(file)));
  folder.write("b.seq", flirFrame(file) + flirFrame(file));
  for (const char* name : {"a.jpg", "b.seq"}) {
    const auto with = openThermalRecording(folder / name)->read(0);
    const auto without =
        openThermalRecording(folder / name,
                             {.t_linear = {}, .named_by = {}, .visible = VisibleInFrame::leave_out})
            ->read(0);
    EXPECT_TRUE(with.metadata.visible) << name;
    EXPECT_FALSE(without.metadata.visible) << name;
    EXPECT_EQ(with.counts, without.counts) << name;
  }
}

/// Frames of 30000 counts from TIFFs with these gains (none: the file does not say), as they are read.
struct ReadScales {
  std::vector<float> celsius;
  std::vector<std::string> warnings;
};

ReadScales scalesRead(const std::vector<std::optional<double>>& gains, std::optional<TLinear> of_rig) {
  const test::TestFolder folder;
  std::string list;
  for (std::size_t i = 0; i < gains.size(); ++i) {
    const std::string name = std::to_string(i) + ".tiff";
    ThermalTiffWriter writer(folder / name, Existing::refuse, {.t_linear_gain = gains[i]});
    writer.add(kWidth, kHeight, std::vector<std::uint16_t>(kWidth * kHeight, 30000));
    writer.commit();
    list += std::to_string(i) + "," + name + "\n";
  }
  ThermalCamera camera = smallCamera();
  camera.t_linear = of_rig;
  ReadScales read;
  const auto frames = readFrames({.list = folder.write("thermal.csv", list),
                                  .folder = folder.path(),
                                  .warn = [&](const std::string& told) { read.warnings.push_back(told); }},
                                 camera);
  while (const auto frame = frames->next()) read.celsius.push_back(frame->image->at(3, 2));
  return read;
}

TEST(ReadFrames, TakesTheRigsScaleBeforeTheFilesAndTellsAContradictionOnce) {
  const ReadScales read = scalesRead({0.02, 0.01, 0.01, std::nullopt}, TLinear{0.02, kAbsoluteZero});
  EXPECT_THAT(read.celsius, testing::Each(testing::FloatNear(326.85F, 1e-3F)));
  ASSERT_EQ(read.warnings.size(), 1U);
  EXPECT_THAT(read.warnings[0], AllOf(HasSubstr("1.tiff"), HasSubstr("0.01 C"), HasSubstr("0.02 C")));
}

TEST(ReadFrames, LeavesTheScaleToTheFilesWhereTheRigDoesNotSayAndTellsAGuessOnce) {
  const ReadScales said = scalesRead({0.02, 0.01}, std::nullopt);
  EXPECT_THAT(said.celsius,
              testing::ElementsAre(testing::FloatNear(326.85F, 1e-3F), testing::FloatNear(26.85F, 1e-3F)));
  EXPECT_TRUE(said.warnings.empty());
  const ReadScales guessed = scalesRead({0.02, std::nullopt, std::nullopt}, std::nullopt);
  EXPECT_THAT(guessed.celsius[2], testing::FloatNear(26.85F, 1e-3F));
  ASSERT_EQ(guessed.warnings.size(), 1U);
  EXPECT_THAT(guessed.warnings[0], AllOf(HasSubstr("1.tiff"), HasSubstr("celsius_per_count")));
  EXPECT_THROW(static_cast<void>(scalesRead({0.0}, std::nullopt)), DataError) << "no temperatures";
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
