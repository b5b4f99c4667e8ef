#include "io/radiometric_jpeg.hpp"
#include "tests/fuzz/fuzz_recording.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace thermovox;
  fuzz::readRecording([&] { return openRadiometricJpeg(std::as_bytes(std::span(data, size)), "fuzz.jpg"); });
  return 0;
}
