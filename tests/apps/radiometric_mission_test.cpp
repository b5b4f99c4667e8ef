// A mission of radiometric JPEGs from end to end: simulated through humid air, decoded, mapped, and compared
// with the same flight by a camera that sees no air.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "apps/simulate/mission_writer.hpp"
#include "apps/simulate/simulated_rig.hpp"
#include "io/mission_folder.hpp"
#include "mapping/mission_mapper.hpp"
#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

/// Decodes every frame with one distance for all of it, as other tools do.
class OneDistance final : public FrameSource {
 public:
  OneDistance(FrameSource& frames, double distance) : frames_(frames), distance_(distance) {}
  std::optional<ThermalFrame> next() override {
    std::optional<ThermalFrame> frame = frames_.next();
    if (!frame) return frame;
    auto image = std::make_shared<ThermalImage>(*frame->image);
    for (float& celsius : image->celsius)
      celsius = static_cast<float>(image->air->at(celsius, distance_).celsius);
    image->air = nullptr;
    frame->image = std::move(image);
    return frame;
  }
  [[nodiscard]] Duration period() const override { return frames_.period(); }

 private:
  FrameSource& frames_;
  double distance_;
};

class RadiometricMission : public testing::Test {
 protected:
  RadiometricMission() {
    options.duration = 1.5;
    options.air = 35.0;
    options.humidity = 0.9;
    simulate::simulateMission(options, folder / "clear");
    options.frames = simulate::FrameFormat::rjpeg;
    simulate::simulateMission(options, folder / "humid");
  }

  /// The coloured points, with the frames decoded for `one_distance` where it is given.
  [[nodiscard]] std::vector<ColouredReturn> pointsOf(const char* mission, const MissionOptions& how = {},
                                                     std::optional<double> one_distance = {}) const {
    OpenedMission opened = openMission(folder / mission, how);
    std::optional<OneDistance> decoded;
    if (one_distance) decoded.emplace(*opened.frames, *one_distance);
    FrameSource* const frames = decoded ? &*decoded : opened.frames.get();
    std::vector<ColouredReturn> points;
    ThermalMap map{ThermalMap::Options{}};
    (void)mapMission({opened.mission, *opened.readings, frames}, map, {},
                     {.points = [&points](std::span<const ColouredReturn> reading) {
                       for (const ColouredReturn& point : reading) {
                         if (point.colour) points.push_back(point);
                       }
                     }});
    return points;
  }

  /// What decoding with `one_distance` makes of a surface that is `range` away.
  [[nodiscard]] double knownError(double celsius, double range, double one_distance) const {
    RadiometricParameters parameters = simulate::makeRadiometry(options);
    parameters.distance = range;
    const double counts = countsOfCelsius(celsius, parameters);
    parameters.distance = one_distance;
    return celsiusOfCounts(counts, parameters) - celsius;
  }

  simulate::SimulationOptions options;
  test::TestFolder folder;
};

/// Beside an edge of temperatures a sample mixes two of them, and the mix is another one in each unit.
constexpr float kFlat = 0.06F;

TEST_F(RadiometricMission, IsColouredAsIfThereWereNoAir) {
  const std::vector<ColouredReturn> clear = pointsOf("clear");
  const std::vector<ColouredReturn> humid = pointsOf("humid");
  ASSERT_EQ(humid.size(), clear.size());
  ASSERT_GT(humid.size(), 10000U);
  std::size_t flat = 0;
  for (std::size_t i = 0; i < humid.size(); ++i) {
    ASSERT_EQ(humid[i].colour->pixel, clear[i].colour->pixel);
    EXPECT_NEAR(humid[i].colour->celsius, clear[i].colour->celsius, 0.5);
    if (clear[i].colour->sigma > kFlat) continue;
    ++flat;
    // A count is 0.01 C, and the air makes noise larger by a tenth.
    EXPECT_NEAR(humid[i].colour->celsius, clear[i].colour->celsius, 0.05);
  }
  EXPECT_GT(flat, humid.size() / 2);
}

TEST_F(RadiometricMission, WouldBeWrongByAKnownAmountWithOneDistanceForAll) {
  constexpr double kOne = 1.0;  // metres: what the camera was left at
  const std::vector<ColouredReturn> clear = pointsOf("clear");
  const std::vector<ColouredReturn> fixed = pointsOf("humid", {}, kOne);
  ASSERT_EQ(fixed.size(), clear.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    const Colour& truth = *clear[i].colour;
    if (truth.sigma > kFlat) continue;
    const double error = fixed[i].colour->celsius - truth.celsius;
    EXPECT_NEAR(error, knownError(truth.celsius, truth.range, kOne), 0.05);
    worst = std::max(worst, std::abs(error));
  }
  EXPECT_GT(worst, 0.5);  // ten times what is left with the points' own distances
}

TEST_F(RadiometricMission, IsColouredByWhatIsKnownBetterThanItsFramesSay) {
  // The frames were made with air of 35 C: taken for -20 C, the same counts mean warmer surfaces.
  const std::vector<ColouredReturn> right = pointsOf("humid");
  const std::vector<ColouredReturn> option =
      pointsOf("humid", {.radiometry = {.atmosphere_temperature = -20.0}});
  const std::string text = test::bytesOf(folder / "humid/mission.yaml");
  folder.write("humid/mission.yaml", text + "ambient: -20\n");
  const std::vector<ColouredReturn> mission = pointsOf("humid");
  const std::vector<ColouredReturn> both =
      pointsOf("humid", {.radiometry = {.atmosphere_temperature = 35.0}});
  ASSERT_EQ(option.size(), right.size());
  for (std::size_t i = 0; i < right.size(); i += 50) {
    EXPECT_NE(option[i].colour->celsius, right[i].colour->celsius);
    EXPECT_EQ(mission[i].colour->celsius, option[i].colour->celsius);
    EXPECT_NEAR(both[i].colour->celsius, right[i].colour->celsius, 1e-4);  // 35 C, and 308.15 K as a float
  }
}

TEST_F(RadiometricMission, OfSurfacesThatMirrorBehindAWindowIsColouredAsTheyAre) {
  options.emissivity = 0.8;
  options.reflected = -5.0;
  options.window_transmission = 0.85;
  options.window_temperature = 45.0;
  simulate::simulateMission(options, folder / "mirrors");
  const std::vector<ColouredReturn> clear = pointsOf("clear");
  const std::vector<ColouredReturn> mirrors = pointsOf("mirrors");
  const std::vector<ColouredReturn> black =
      pointsOf("mirrors", {.radiometry = {.emissivity = 1.0, .window_transmission = 1.0}});
  ASSERT_EQ(mirrors.size(), clear.size());
  ASSERT_EQ(black.size(), clear.size());
  constexpr float kSure = 0.05F;
  std::size_t sure = 0;
  double most_wrong = 0.0;
  for (std::size_t i = 0; i < mirrors.size(); ++i) {
    // Those that say they are sure to 0.05 C. Where something else stands beside a surface at another
    // distance the air before the two differs: an edge that the camera without air need not see.
    if (std::max(clear[i].colour->sigma, mirrors[i].colour->sigma) > kSure) continue;
    ++sure;
    // A count is 0.015 C of such a surface.
    EXPECT_NEAR(mirrors[i].colour->celsius, clear[i].colour->celsius, kSure);
    most_wrong = std::max<double>(most_wrong, std::abs(black[i].colour->celsius - clear[i].colour->celsius));
  }
  EXPECT_GT(sure, mirrors.size() / 4) << mirrors.size();
  EXPECT_GT(most_wrong, 2.0) << "what their mirroring and the window add, if nobody knew of them";
}

TEST_F(RadiometricMission, MayNotBeToldWhatACameraHasSettledItself) {
  EXPECT_THROW(static_cast<void>(pointsOf("clear", {.radiometry = {.emissivity = 0.9}})), DataError);
  folder.write("clear/mission.yaml", test::bytesOf(folder / "clear/mission.yaml") + "ambient: -20\n");
  EXPECT_FALSE(pointsOf("clear").empty());  // the air is a fact of the mission, whatever the camera
}

}  // namespace
}  // namespace thermovox
