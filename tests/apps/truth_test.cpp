#include "apps/simulate/truth.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/simulate/random.hpp"
#include "projection/error.hpp"
#include "tests/apps/simulated_sweeps.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox::simulate {
namespace {

TEST(Truth, TheHallReadsBackAsItWasWritten) {
  const test::TestFolder folder;
  const Simulation simulation(optionsOf(LaserKind::scan));
  const Hall& written = simulation.hall();
  const Hall read = readTrueHall(folder.write("truth.json", truthText(simulation, 1)));
  EXPECT_EQ(read.size(), written.size());
  ASSERT_EQ(read.boxes().size(), written.boxes().size());
  ASSERT_EQ(read.cylinders().size(), written.cylinders().size());
  ASSERT_EQ(read.hotSpots().size(), written.hotSpots().size());
  Random random(4, RandomStream::laser);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d p(random.uniform(-0.5, 0.5) * written.size().x(),
                            random.uniform(-0.5, 0.5) * written.size().y(),
                            random.uniform(0.0, written.size().z()));
    ASSERT_EQ(read.nearestSurface(p).temperature, written.nearestSurface(p).temperature);
    ASSERT_EQ(read.nearestSurface(p).distance, written.nearestSurface(p).distance);
  }
}

TEST(Truth, AFileThatIsNoneIsRefusedByName) {
  const test::TestFolder folder;
  const auto refused = [&](const std::string& text) {
    const auto file = folder.write("truth.json", text);
    return test::messageOf<DataError>([&] { (void)readTrueHall(file); });
  };
  EXPECT_THAT(refused("{"), testing::HasSubstr("truth.json"));
  EXPECT_THAT(refused("[1, 2]"), testing::HasSubstr("truth.json"));
  EXPECT_THAT(refused(R"({"size": [1, 2], "boxes": [], "cyls": [], "hotspots": []})"),
              testing::HasSubstr("truth.json"));
  EXPECT_THAT(test::messageOf<DataError>([&] { (void)readTrueHall(folder / "none.json"); }),
              testing::HasSubstr("no such file"));
}

}  // namespace
}  // namespace thermovox::simulate
