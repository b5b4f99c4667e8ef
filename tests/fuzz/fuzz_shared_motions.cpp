#include "io/shared_motion_codec.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace thermovox;
  const std::string bytes = fuzz::textOf(data, size);
  fuzz::read([&] {
    const std::vector<SharedMotion> motions = decodeSharedMotions(bytes);
    fuzz::require(encodeSharedMotions(motions) == bytes);
    // What was read is worked with: the laser's number is what stations check apart.
    Rig rig;
    rig.lasers.resize(1);
    std::vector<SharedMotion> of_rig = motions;
    for (SharedMotion& motion : of_rig) motion.laser = 0;
    const Eigen::Vector3d p_world(0.5, 0.5, 0.5), normal(0.0, 0.0, 1.0);
    (void)sharedCovariance(p_world, normal, of_rig, rig, {.rotation = 0.01, .translation = 0.01});
    (void)moved(motions, {expRotation({0.1, 0.2, 0.3}), {1e6, 0.0, -1e6}});
  });
  return 0;
}
