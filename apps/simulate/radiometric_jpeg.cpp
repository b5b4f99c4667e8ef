#include "apps/simulate/radiometric_jpeg.hpp"

#include <algorithm>
#include <cstddef>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "apps/simulate/flir_writer.hpp"
#include "apps/simulate/instrument_files.hpp"
#include "io/little_endian.hpp"

namespace thermovox::simulate {
namespace {

constexpr std::size_t kCameraInfoSize = 1088;
constexpr std::uint16_t kRawLittleEndian = 2;

std::string rawRecord(int width, std::span<const std::uint16_t> counts) {
  std::string pixels;
  pixels.reserve(counts.size_bytes());
  for (const std::uint16_t count : counts) appendLittleEndian(pixels, count);
  const int height = static_cast<int>(counts.size()) / width;
  return flirPixelRecord(width, height, pixels, ByteOrder::little);
}

std::string frameOf(int width, std::span<const std::uint16_t> counts,
                    const RadiometricParameters& parameters) {
  const WrittenCamera camera{.parameters = parameters,
                             .model = "thermovox simulated",
                             .range_low = 230.0 + kAbsoluteZero,
                             .range_high = 550.0 + kAbsoluteZero};
  return flirFrame(
      {{static_cast<std::uint16_t>(FlirRecordType::raw_data), kRawLittleEndian, rawRecord(width, counts)},
       {static_cast<std::uint16_t>(FlirRecordType::camera_info), 0,
        flirCameraRecord(camera, kCameraInfoSize, ByteOrder::little)}},
      "THERMOVOX", ByteOrder::little);
}

std::vector<unsigned char> picture(int width, std::span<const std::uint16_t> counts) {
  const auto extremes = std::minmax_element(counts.begin(), counts.end());
  const auto coldest = extremes.first, hottest = extremes.second;
  const int span = std::max(*hottest - *coldest, 1);
  cv::Mat grey(static_cast<int>(counts.size()) / width, width, CV_8U);
  std::transform(counts.begin(), counts.end(), grey.begin<unsigned char>(), [&](std::uint16_t count) {
    return static_cast<unsigned char>((count - *coldest) * 255 / span);
  });
  std::vector<unsigned char> jpeg;
  cv::imencode(".jpg", grey, jpeg);
  return jpeg;
}

}  // namespace

void writeRadiometricJpeg(const std::filesystem::path& path, int width, std::span<const std::uint16_t> counts,
                          const RadiometricParameters& parameters) {
  const std::vector<unsigned char> jpeg = picture(width, counts);
  std::string file(jpeg.begin(), jpeg.end());
  std::string segments;
  for (const std::string& segment : flirSegments(frameOf(width, counts, parameters))) segments += segment;
  constexpr std::size_t kStart = 2;  // bytes of the marker that every JPEG begins with
  file.insert(kStart, segments);
  writeText(path, file);
}

}  // namespace thermovox::simulate
