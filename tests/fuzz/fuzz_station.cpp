#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "io/station.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace thermovox;
  static const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("fuzz-" + std::to_string(getpid()) + ".tvx");
  std::ofstream(file, std::ios::binary | std::ios::trunc) << fuzz::textOf(data, size);
  fuzz::read([&] {
    const Station station = Station::open(file);
    const bool sound = station.verify().empty();
    fuzz::read([&] { (void)station.missions(); });
    // A map whose tiles are sound loads.
    bool loads = false;
    fuzz::read([&] {
      (void)station.loadMap();
      loads = true;
    });
    fuzz::require(loads || !sound);
  });
  std::filesystem::remove(file);
  return 0;
}
