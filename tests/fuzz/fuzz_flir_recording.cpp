#include "io/flir_recording.hpp"
#include "tests/fuzz/fuzz_recording.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace thermovox;
  fuzz::readRecording(
      [&] { return openFlirRecording(ByteSource(std::as_bytes(std::span(data, size)), "fuzz.seq")); });
  return 0;
}
