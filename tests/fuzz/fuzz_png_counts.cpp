#include "io/png_counts.hpp"

#include <span>

#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace thermovox;
  fuzz::read([&] {
    const CountsPicture picture = decodePngCounts(std::as_bytes(std::span(data, size)), "fuzz");
    fuzz::require(picture.width > 0 && picture.height > 0);
    fuzz::require(picture.counts.size() ==
                  static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
  });
  return 0;
}
