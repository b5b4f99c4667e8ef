#include <cmath>

#include "io/tum_trajectory.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace thermovox;
  fuzz::read([&] {
    const auto stream = fuzz::streamOf(data, size);
    const Trajectory trajectory(readTumTrajectory(*stream, "fuzz.tum"));
    for (const StampedPose& pose : trajectory.poses()) {
      fuzz::require(pose.T_world_body.translation.allFinite());
      fuzz::require(std::abs(pose.T_world_body.rotation.norm() - 1.0) < 1e-12);
    }
  });
  return 0;
}
