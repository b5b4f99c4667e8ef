#include "io/point_cloud_file.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace thermovox;
  fuzz::read([&] { static_cast<void>(parseCloudPoints(fuzz::textOf(data, size), "fuzz.ply")); });
  return 0;
}
