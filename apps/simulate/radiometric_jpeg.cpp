#include "apps/simulate/radiometric_jpeg.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "apps/simulate/instrument_files.hpp"
#include "io/little_endian.hpp"

namespace thermovox::simulate {
namespace {

constexpr std::size_t kChunk = 65000;  // bytes of the FFF block in a segment, which holds less than 65536
constexpr std::size_t kRecordHeader = 32;
constexpr std::size_t kCameraInfoSize = 1088;
constexpr std::uint16_t kRawData = 1, kRawLittleEndian = 2;
constexpr std::uint16_t kCameraInfo = 32;

/// Bytes whose numbers are little-endian.
class Bytes {
 public:
  explicit Bytes(std::size_t size) : bytes_(size, '\0') {}
  template <typename Number>
  void put(std::size_t offset, Number value) {
    std::string number;
    appendLittleEndian(number, value);
    bytes_.replace(offset, number.size(), number);
  }
  void put(std::size_t offset, double value) { put(offset, static_cast<float>(value)); }
  void put(std::size_t offset, std::string_view text) { bytes_.replace(offset, text.size(), text); }
  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

std::string rawRecord(int width, std::span<const std::uint16_t> counts) {
  Bytes record(kRecordHeader + counts.size_bytes());
  record.put(0, std::uint16_t{2});  // 2 in the right byte order
  record.put(2, static_cast<std::uint16_t>(width));
  record.put(4, static_cast<std::uint16_t>(counts.size() / static_cast<std::size_t>(width)));
  for (std::size_t i = 0; i < counts.size(); ++i) record.put(kRecordHeader + 2 * i, counts[i]);
  return record.take();
}

/// Offsets as exiftool documents them; temperatures in kelvin.
std::string cameraInfoRecord(const RadiometricParameters& of) {
  Bytes record(kCameraInfoSize);
  record.put(0, std::uint16_t{2});
  record.put(0x20, of.emissivity);
  record.put(0x24, of.distance);
  record.put(0x28, of.reflected - kAbsoluteZero);
  record.put(0x2C, of.atmosphere_temperature - kAbsoluteZero);
  record.put(0x30, of.window_temperature - kAbsoluteZero);
  record.put(0x34, of.window_transmission);
  record.put(0x3C, of.humidity);
  record.put(0x58, of.planck.r1);
  record.put(0x5C, of.planck.b);
  record.put(0x60, of.planck.f);
  record.put(0x70, of.atmosphere.alpha1);
  record.put(0x74, of.atmosphere.alpha2);
  record.put(0x78, of.atmosphere.beta1);
  record.put(0x7C, of.atmosphere.beta2);
  record.put(0x80, of.atmosphere.x);
  record.put(0x90, 550.0);  // the calibrated range, high and low
  record.put(0x94, 230.0);
  record.put(0xD4, std::string_view("thermovox simulated"));
  record.put(0x308, static_cast<std::int32_t>(std::lround(of.planck.o)));
  record.put(0x30C, of.planck.r2);
  return record.take();
}

std::string fffBlock(const std::string& raw, const std::string& camera_info) {
  constexpr std::size_t kHeader = 64, kEntry = 32;
  constexpr std::size_t kRecords = kHeader + 2 * kEntry;
  Bytes header(kRecords);
  header.put(0, std::string_view("FFF\0", 4));
  header.put(0x04, std::string_view("THERMOVOX"));
  header.put(0x14, std::uint32_t{101});  // version
  header.put(0x18, static_cast<std::uint32_t>(kHeader));
  header.put(0x1C, std::uint32_t{2});  // entries
  const auto entry = [&](std::size_t place, std::uint16_t type, std::uint16_t subtype, std::size_t offset,
                         std::size_t size) {
    header.put(place, type);
    header.put(place + 2, subtype);
    header.put(place + 4, std::uint32_t{101});
    header.put(place + 12, static_cast<std::uint32_t>(offset));
    header.put(place + 16, static_cast<std::uint32_t>(size));
  };
  entry(kHeader, kRawData, kRawLittleEndian, kRecords, raw.size());
  entry(kHeader + kEntry, kCameraInfo, 0, kRecords + raw.size(), camera_info.size());
  return header.take() + raw + camera_info;
}

std::string segmentsOf(const std::string& fff) {
  const std::size_t chunks = (fff.size() + kChunk - 1) / kChunk;
  std::string segments;
  for (std::size_t i = 0; i < chunks; ++i) {
    const std::string part = fff.substr(i * kChunk, kChunk);
    const std::size_t length = part.size() + 10;  // with the length itself and FLIR's eight bytes
    segments += {'\xFF', '\xE1', static_cast<char>(length >> 8), static_cast<char>(length & 0xFF)};
    segments += std::string("FLIR\0\1", 6);
    segments += {static_cast<char>(i), static_cast<char>(chunks - 1)};
    segments += part;
  }
  return segments;
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
  constexpr std::size_t kStart = 2;  // bytes of the marker that every JPEG begins with
  file.insert(kStart, segmentsOf(fffBlock(rawRecord(width, counts), cameraInfoRecord(parameters))));
  writeText(path, file);
}

}  // namespace thermovox::simulate
