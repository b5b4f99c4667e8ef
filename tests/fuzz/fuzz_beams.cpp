#include "io/laser_sources.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace thermovox;
  Laser laser;
  laser.kind = LaserKind::beam;
  laser.time_increment = std::chrono::microseconds(17);
  fuzz::read([&] {
    const auto source = readLaser({"", "fuzz.csv", fuzz::streamOf(data, size)}, laser, 0);
    while (const auto reading = source->next()) {
      for (const LaserReturn& echo : reading->returns) fuzz::require(echo.p_laser.allFinite());
    }
  });
  return 0;
}
