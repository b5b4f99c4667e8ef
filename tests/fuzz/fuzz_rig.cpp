#include "io/rig_file.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace thermovox;
  fuzz::read([&] {
    const std::string written = rigText(parseRig(fuzz::textOf(data, size), "fuzz.yaml"));
    std::string again;
    fuzz::read([&] { again = rigText(parseRig(written, "written.yaml")); });
    fuzz::require(again == written);
  });
  return 0;
}
