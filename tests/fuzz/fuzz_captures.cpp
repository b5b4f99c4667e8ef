#include "io/capture_folder.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace thermovox;
  fuzz::read([&] {
    const CapturesFile captures = parseCapturesFile(fuzz::textOf(data, size), "fuzz.yaml");
    const CalibrationBoard& board = captures.board;
    fuzz::require(!captures.name.empty() && !captures.captures.empty() && !captures.rig.empty());
    fuzz::require(board.columns >= 3 && board.columns <= 64 && board.rows >= 3 && board.rows <= 64);
    fuzz::require(board.square > 0.0 && (board.width > 0.0) == (board.height > 0.0));
  });
  fuzz::read([&] {
    const auto captures = readCaptureList(fuzz::streamOf(data, size), "fuzz.csv", "folder");
    fuzz::require(!captures.empty());
    for (const CaptureFiles& capture : captures) {
      fuzz::require(!capture.name.empty() && (capture.thermal || capture.visible || capture.laser));
    }
  });
  return 0;
}
