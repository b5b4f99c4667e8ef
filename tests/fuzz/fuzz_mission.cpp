#include "io/mission_folder.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace thermovox;
  fuzz::read([&] {
    const MissionFile mission = parseMissionFile(fuzz::textOf(data, size), "fuzz.yaml");
    fuzz::require(!mission.name.empty() && !mission.lasers.empty());
    fuzz::require(mission.pose_rotation_sigma >= 0.0 && mission.pose_translation_sigma >= 0.0);
  });
  return 0;
}
