#include "apps/simulate/instrument_files.hpp"

#include <tiffio.h>

#include <cstdarg>
#include <cstring>
#include <fstream>
#include <memory>
#include <vector>

#include "projection/error.hpp"

namespace thermovox::simulate {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path) {
  throw DataError(path.string() + ": could not be written, expected a folder with room for it");
}

struct FreeOptions {
  void operator()(TIFFOpenOptions* options) const { TIFFOpenOptionsFree(options); }
};

/// libtiff would print what goes wrong; its return values say it too.
int passOver(TIFF* /*tiff*/, void* /*user_data*/, const char* /*module*/, const char* /*format*/,
             va_list /*arguments*/) {
  return 1;
}

std::unique_ptr<TIFF, decltype(&TIFFClose)> createTiff(const std::filesystem::path& path) {
  const std::unique_ptr<TIFFOpenOptions, FreeOptions> options(TIFFOpenOptionsAlloc());
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), passOver, nullptr);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), passOver, nullptr);
  return {TIFFOpenExt(path.c_str(), "w", options.get()), &TIFFClose};
}

}  // namespace

void writeThermalTiff(const std::filesystem::path& path, int width, std::span<const std::uint16_t> counts) {
  const auto tiff = createTiff(path);
  if (!tiff) refuse(path);
  const auto columns = static_cast<std::size_t>(width);
  const std::size_t rows = counts.size() / columns;
  TIFFSetField(tiff.get(), TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(columns));
  TIFFSetField(tiff.get(), TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(rows));
  TIFFSetField(tiff.get(), TIFFTAG_BITSPERSAMPLE, 16);
  TIFFSetField(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff.get(), TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  TIFFSetField(tiff.get(), TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff.get(), TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff.get(), TIFFTAG_ROWSPERSTRIP, static_cast<std::uint32_t>(rows));
  TIFFSetField(tiff.get(), TIFFTAG_COMPRESSION, COMPRESSION_LZW);
  TIFFSetField(tiff.get(), TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL);
  std::vector<std::uint16_t> line(columns);  // libtiff differences the buffer that it is given
  for (std::size_t row = 0; row < rows; ++row) {
    std::memcpy(line.data(), counts.data() + row * columns, columns * sizeof(std::uint16_t));
    if (TIFFWriteScanline(tiff.get(), line.data(), static_cast<std::uint32_t>(row), 0) != 1) refuse(path);
  }
  if (TIFFFlush(tiff.get()) != 1) refuse(path);
}

void writeCloudPcd(const std::filesystem::path& path, std::span<const CloudPoint> points, PointTimes times) {
  const bool timed = times == PointTimes::written;
  const std::string count = std::to_string(points.size());
  std::string file = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n";
  file += timed ? "FIELDS x y z intensity time\nSIZE 4 4 4 4 4\nTYPE F F F F F\nCOUNT 1 1 1 1 1\n"
                : "FIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\n";
  file += "WIDTH " + count + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA binary\n";
  for (const CloudPoint& point : points) {
    const float values[5] = {point.p_laser.x(), point.p_laser.y(), point.p_laser.z(), point.intensity,
                             static_cast<float>(point.time)};
    file.append(reinterpret_cast<const char*>(values), (timed ? 5 : 4) * sizeof(float));
  }
  writeText(path, file);
}

void writeText(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  if (!file) refuse(path);
}

}  // namespace thermovox::simulate
