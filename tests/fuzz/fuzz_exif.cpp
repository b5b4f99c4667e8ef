#include "io/exif.hpp"

#include <span>

#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace thermovox;
  const ExifFacts facts = exifFacts(std::as_bytes(std::span(data, size)));
  for (const std::string* text : {&facts.make, &facts.model, &facts.software, &facts.time})
    fuzz::require(text->size() <= 256);
  return 0;
}
