// Cells as a damaged or forged file may hold them.
#include "mapping/surface_cell.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace thermovox {
namespace {

/// A cell of a return and five temperatures from 18 to 22 C.
SurfaceCell soundCell() {
  SurfaceCell cell;
  cell.addReturn({0.25, 0.5, 0.75});
  for (int i = 0; i < 5; ++i) {
    const TemperatureObservation seen{18.0F + static_cast<float>(i), 0.5F, 5.0F, 0.0F};
    cell.addTemperature(seen, Time(std::chrono::seconds(i)));
  }
  return cell;
}

/// Whether the cell passes once `damage` was done to it.
template <typename Damage>
bool passes(SurfaceCell cell, Damage&& damage) {
  damage(cell);
  return cell.isPlausible();
}

std::uint64_t times(std::uint64_t sum, double factor) {
  return static_cast<std::uint64_t>(static_cast<double>(sum) * factor);
}

/// As SurfaceCell::min_code and max_code count.
std::uint64_t codeOf(double celsius) {
  return static_cast<std::uint64_t>((celsius + 274.0) * 16.0);
}

TEST(PlausibleCell, HasCountsThatCanBe) {
  const SurfaceCell cell = soundCell();
  ASSERT_TRUE(cell.isPlausible());
  EXPECT_FALSE(SurfaceCell().isPlausible());  // no return, no place
  EXPECT_FALSE(passes(cell, [](SurfaceCell& c) { c.returns = 0; }));
  EXPECT_FALSE(passes(cell, [](SurfaceCell& c) { c.observations = SurfaceCell::kMaxObservations + 1; }));
  EXPECT_FALSE(passes(cell, [](SurfaceCell& c) { c.offset_sum[2] = 256; }));
  EXPECT_FALSE(passes(cell, [](SurfaceCell& c) { c.observations = 0; }));
  EXPECT_FALSE(passes(cell, [](SurfaceCell& c) { c.observations = 1; }));
  EXPECT_FALSE(passes(cell, [](SurfaceCell& c) { c.first_code += 5; }));
  EXPECT_FALSE(passes(cell, [](SurfaceCell& c) { c.best_incidence = 158; }));
  EXPECT_TRUE(passes(cell, [](SurfaceCell& c) { c.best_incidence = SurfaceCell::kUnknownIncidence; }));
}

TEST(PlausibleCell, HasNoTracesOfTemperaturesThatItDoesNotCount) {
  SurfaceCell cell;
  cell.addReturn({0, 0, 0});
  ASSERT_TRUE(cell.isPlausible());
  EXPECT_FALSE(passes(cell, [](SurfaceCell& c) { c.weight_sum = 1; }));
  EXPECT_FALSE(passes(cell, [](SurfaceCell& c) { c.best_range_cm = 1; }));
  EXPECT_FALSE(passes(cell, [](SurfaceCell& c) { c.last_code = 1; }));
  EXPECT_FALSE(passes(cell, [](SurfaceCell& c) { c.max_code = 1; }));
  EXPECT_FALSE(passes(cell, [](SurfaceCell& c) { c.common_code = 1; }));
}

TEST(PlausibleCell, HasSumsThatItsCountsCanGive) {
  const SurfaceCell cell = soundCell();
  const auto scaled = [](double factor) {  // all in proportion: the moments still fit
    return [factor](SurfaceCell& c) {
      c.weight_sum = times(c.weight_sum, factor);
      c.weighted_sum = times(c.weighted_sum, factor);
      c.weighted_square_sum = times(c.weighted_square_sum, factor);
    };
  };
  EXPECT_TRUE(passes(cell, scaled(2.0)));
  EXPECT_FALSE(passes(cell, scaled(1e4)));  // more than five observations of the smallest sigma
  EXPECT_FALSE(passes(cell, [](SurfaceCell& c) { c.weight_sum = 4; }));
  EXPECT_FALSE(passes(cell, [](SurfaceCell& c) { c.weight_sum = 0; }));
  SurfaceCell one;
  one.addReturn(Eigen::Vector3d::Constant(0.5));
  one.addTemperature({.celsius = 20.0F, .sigma = 0.1F, .range = 3.0F}, Time(std::chrono::hours(12)));
  EXPECT_TRUE(passes(one, [](SurfaceCell&) {}));
  EXPECT_FALSE(passes(one, [](SurfaceCell& c) { c.common_code = 200; }));  // 19 C: too heavy for that
}

TEST(PlausibleCell, HasMomentsThatFitItsExtremes) {
  const SurfaceCell cell = soundCell();
  EXPECT_FALSE(passes(cell, [](SurfaceCell& c) { c.min_code = codeOf(20.5); }));
  EXPECT_FALSE(passes(cell, [](SurfaceCell& c) { c.max_code = codeOf(19.5); }));
  EXPECT_FALSE(passes(cell, [](SurfaceCell& c) { c.min_code = codeOf(-274.0); }));
  EXPECT_FALSE(passes(cell, [](SurfaceCell& c) { c.max_code = codeOf(3001.0); }));
  // The mean square lies between the mean's square and the extremes'.
  EXPECT_FALSE(passes(cell, [](SurfaceCell& c) { c.weighted_square_sum = 0; }));
  EXPECT_FALSE(passes(cell, [](SurfaceCell& c) { c.weighted_square_sum += std::uint64_t{1} << 62; }));
  EXPECT_FALSE(
      passes(cell, [](SurfaceCell& c) { c.weighted_square_sum = times(c.weighted_square_sum, 0.9999); }));
  EXPECT_FALSE(
      passes(cell, [](SurfaceCell& c) { c.weighted_square_sum = times(c.weighted_square_sum, 1.02); }));
}

}  // namespace
}  // namespace thermovox
