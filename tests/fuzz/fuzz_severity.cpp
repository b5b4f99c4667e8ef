#include "io/severity_file.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace thermovox;
  fuzz::read([&] {
    const SeverityTable table = parseSeverity(fuzz::textOf(data, size), "fuzz.yaml");
    for (const SeverityBasis basis : {SeverityBasis::over_ambient, SeverityBasis::over_similar}) {
      double lower = 0.0;
      for (const SeverityClass& one : table.classes(basis)) {
        fuzz::require(one.up_to > lower && table.classOf(basis, one.up_to) == &one);
        lower = one.up_to;
      }
    }
  });
  return 0;
}
