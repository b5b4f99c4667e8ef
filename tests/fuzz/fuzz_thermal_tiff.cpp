#include <cmath>
#include <span>

#include "io/thermal_tiff.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace thermovox;
  for (const int page : {0, 1}) {
    fuzz::read([&] {
      const ThermalImage image = readThermalTiff(std::as_bytes(std::span(data, size)), "fuzz.tiff", page, {});
      fuzz::require(image.width > 0 && image.height > 0);
      fuzz::require(image.celsius.size() == static_cast<std::size_t>(image.width) * image.height);
      for (const float celsius : image.celsius) fuzz::require(!std::isinf(celsius));
    });
  }
  return 0;
}
