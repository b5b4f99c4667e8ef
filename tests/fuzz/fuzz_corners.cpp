#include "io/corner_file.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace thermovox;
  const CalibrationBoard board{.columns = 3, .rows = 3, .square = 0.1};
  fuzz::read([&] {
    const auto corners = readCorners(fuzz::streamOf(data, size), "fuzz.csv", board);
    fuzz::require(corners.size() == 9);
    for (const Eigen::Vector2d& corner : corners) fuzz::require(corner.allFinite());
  });
  return 0;
}
