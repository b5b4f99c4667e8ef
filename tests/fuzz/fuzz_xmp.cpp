#include "io/xmp.hpp"

#include <cmath>

#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace thermovox;
  const std::string packet = fuzz::textOf(data, size);
  for (const char* name : {"TlinearGain", "Yaw", "PerspectiveDistortion"}) {
    const auto number = xmpNumber(packet, name);
    fuzz::require(!number || std::isfinite(*number));
  }
  static_cast<void>(xmpFacts(packet));
  return 0;
}
