#include <span>

#include "io/visible_picture.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace thermovox;
  fuzz::read([&] {
    const VisiblePicture picture = decodeVisiblePicture(std::as_bytes(std::span(data, size)), "fuzz");
    fuzz::require(picture.width > 0 && picture.height > 0);
    fuzz::require(picture.luminance.size() ==
                  static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
  });
  return 0;
}
