// From the bytes of a file to Celsius on one core: opening, decoding, temperatures. `warm` keeps the table of
// temperatures from image to image, as a mission does; `cold` makes it anew. The files are the project's own
// (calm scenes); files named on the command line are measured too. Beside the packed ones `peer`: charls and
// OpenCV (libpng) unpack the same counts, to counts alone.

#include <benchmark/benchmark.h>
#include <charls/charls.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "io/celsius_decoder.hpp"
#include "io/thermal_recording.hpp"
#include "tests/io/flir_file.hpp"
#include "tests/io/tiff_writer.hpp"

namespace thermovox::bench {
namespace {

enum class Table { warm, cold };

void decode(benchmark::State& state, const std::string& bytes, Table table) {
  CelsiusDecoder decoder;
  for (auto _ : state) {
    if (table == Table::cold) decoder = CelsiusDecoder();
    const auto recording = openThermalRecording(std::as_bytes(std::span(bytes)), "image");
    const ThermalImage image = decoder.decode(recording->read(0), "image");
    benchmark::DoNotOptimize(image.celsius.data());
  }
}

void add(const std::string& name, const std::string& bytes) {
  for (const Table table : {Table::warm, Table::cold}) {
    const std::string full = "decode/" + name + (table == Table::warm ? "/warm" : "/cold");
    benchmark::RegisterBenchmark(full.c_str(), [bytes, table](benchmark::State& state) {
      decode(state, bytes, table);
    })->Unit(benchmark::kMicrosecond);
  }
}

void addPeers(const std::string& size, const std::string& png, const std::string& jpeg_ls) {
  benchmark::RegisterBenchmark(("peer/png_" + size).c_str(), [png](benchmark::State& state) {
    const std::vector<std::uint8_t> bytes(png.begin(), png.end());
    for (auto _ : state) benchmark::DoNotOptimize(cv::imdecode(bytes, cv::IMREAD_UNCHANGED).data);
  })->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark(("peer/jpeg_ls_" + size).c_str(), [jpeg_ls](benchmark::State& state) {
    for (auto _ : state) {
      charls::jpegls_decoder decoder(jpeg_ls, true);
      std::vector<std::uint16_t> counts(decoder.destination_size() / sizeof(std::uint16_t));
      decoder.decode(counts);
      benchmark::DoNotOptimize(counts.data());
    }
  })->Unit(benchmark::kMicrosecond);
}

std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string tiffOf(const test::FlirFile& file) {
  const auto path = std::filesystem::temp_directory_path() / "thermovox-benchmark.tiff";
  writeTiff(path, test::TiffPages<std::uint16_t>{file.width, file.height, {file.counts}});
  std::string bytes = bytesOf(path);
  std::filesystem::remove(path);
  return bytes;
}

void addOwnFiles(int width, int height) {
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  test::FlirFile file{
      .width = width, .height = height, .counts = test::calmCounts(width, height), .parameters = test::e40()};
  const auto jpeg = [&](test::FlirPacking packing) {
    file.packing = packing;
    return test::radiometricJpeg(flirFrame(file));
  };
  add("raw_" + size, jpeg(test::FlirPacking::raw_little));
  add("png_" + size, jpeg(test::FlirPacking::png));
  add("jpeg_ls_" + size, jpeg(test::FlirPacking::jpeg_ls));
  addPeers(size, test::grey16Png(width, height, file.counts), test::jpegLs(width, height, file.counts));
  for (std::uint16_t& count : file.counts) count = static_cast<std::uint16_t>(count + 12000);  // 0.01 K each
  add("tiff_" + size, tiffOf(file));
}

}  // namespace
}  // namespace thermovox::bench

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  thermovox::bench::addOwnFiles(160, 120);
  thermovox::bench::addOwnFiles(640, 512);
  for (int i = 1; i < argc; ++i) {  // what is no option is a file
    thermovox::bench::add(std::filesystem::path(argv[i]).filename(), thermovox::bench::bytesOf(argv[i]));
  }
  benchmark::RunSpecifiedBenchmarks();
}
