#include "io/stamped_files.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace thermovox;
  fuzz::read([&] {
    CsvReader csv(fuzz::streamOf(data, size), "fuzz.csv");
    while (csv.next()) fuzz::require(!csv.fields().empty());
  });
  fuzz::read([&] {
    StampedFiles files(fuzz::streamOf(data, size), "fuzz.csv", "folder", StampedFiles::Pages::allow);
    std::optional<Time> previous;
    while (const auto row = files.next()) {
      fuzz::require(!previous || *previous < row->stamp);
      fuzz::require(row->page >= 0 && !row->written.empty());
      previous = row->stamp;
    }
  });
  return 0;
}
