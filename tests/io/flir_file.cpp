#include "tests/io/flir_file.hpp"

#include <charls/charls.h>
#include <libdeflate.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <random>
#include <stdexcept>
#include <utility>

#include "apps/simulate/flir_writer.hpp"

namespace thermovox::test {
namespace {

template <typename T>
void append(std::string& bytes, T number, ByteOrder order) {
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    const std::size_t place = order == ByteOrder::little ? i : sizeof(T) - 1 - i;
    bytes += static_cast<char>(number >> 8 * place);
  }
}

std::string inOrder(const std::vector<std::uint16_t>& counts, ByteOrder order) {
  std::string bytes;
  for (const std::uint16_t count : counts) append(bytes, count, order);
  return bytes;
}

std::vector<std::uint16_t> swapped(std::vector<std::uint16_t> counts) {
  for (std::uint16_t& count : counts) count = static_cast<std::uint16_t>(count << 8 | count >> 8);
  return counts;
}

std::string packed(const FlirFile& file) {
  switch (file.packing) {
    case FlirPacking::raw_little:
      return inOrder(file.counts, ByteOrder::little);
    case FlirPacking::raw_big:
      return inOrder(file.counts, ByteOrder::big);
    case FlirPacking::png: {
      const bool little = file.png_samples.value_or(file.records) == ByteOrder::little;
      return grey16Png(file.width, file.height, little ? swapped(file.counts) : file.counts);
    }
    case FlirPacking::jpeg_ls:
      break;
  }
  return jpegLs(file.width, file.height, file.counts);
}

std::string cameraInfo(const FlirFile& file) {
  return simulate::flirCameraRecord({.parameters = file.parameters,
                                     .model = file.model,
                                     .serial = "64502173",
                                     .lens = "FOL18",
                                     .range_low = -20.0,
                                     .range_high = 120.0,
                                     .field_of_view_deg = 25.0,
                                     .unix_seconds = 1365762241,  // 2013-04-12 10:24:01 UTC
                                     .milliseconds = 131,
                                     .minutes_behind = 60},
                                    file.camera_info_size, file.records);
}

std::string pngChunk(const std::string& type, const std::string& data) {
  std::string chunk;
  append(chunk, static_cast<std::uint32_t>(data.size()), ByteOrder::big);
  const std::string body = type + data;
  chunk += body;
  append(chunk, libdeflate_crc32(0, body.data(), body.size()), ByteOrder::big);
  return chunk;
}

int nearest(int left, int up, int corner) {
  const int guess = left + up - corner;
  const int a = std::abs(guess - left);
  const int b = std::abs(guess - up);
  const int c = std::abs(guess - corner);
  return a <= b && a <= c ? left : b <= c ? up : corner;
}

/// One row of a PNG, filtered by one of PNG's five ways.
std::string filtered(const std::string& row, const std::string& above, int filter) {
  std::string bytes(1, static_cast<char>(filter));
  for (std::size_t i = 0; i < row.size(); ++i) {
    const int left = i < 2 ? 0 : static_cast<unsigned char>(row[i - 2]);
    const int up = static_cast<unsigned char>(above[i]);
    const int corner = i < 2 ? 0 : static_cast<unsigned char>(above[i - 2]);
    const int guesses[] = {0, left, up, (left + up) / 2, nearest(left, up, corner)};
    bytes += static_cast<char>(row[i] - guesses[filter]);
  }
  return bytes;
}

}  // namespace

RadiometricParameters e40() {
  RadiometricParameters parameters;
  parameters.planck = {.r1 = 14259.625, .r2 = 0.010985606, .b = 1383.2, .f = 1.0, .o = -5667.0};
  return parameters;
}

std::vector<std::uint16_t> calmCounts(int width, int height, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::uint16_t> counts;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u)
      counts.push_back(static_cast<std::uint16_t>(17500 + 3 * u + 5 * v + static_cast<int>(random() % 20)));
  }
  return counts;
}

std::string flirFrame(const FlirFile& file) {
  std::vector<simulate::WrittenRecord> records;
  records.push_back({0x20, 1, cameraInfo(file)});
  records.push_back({0, 0, ""});  // an empty entry, as cameras leave them
  records.push_back({0x01, static_cast<std::uint16_t>(file.packing),
                     simulate::flirPixelRecord(file.width, file.height, packed(file), file.records)});
  if (file.picture_in_picture)
    records.push_back({0x2A, 1, simulate::flirPictureInPictureRecord(2.5F, {-50, -40, 36, 123, 27, 92})});
  if (!file.visible_jpeg.empty())
    records.push_back({0x0E, 5, simulate::flirPixelRecord(4, 3, file.visible_jpeg, file.records)});
  return simulate::flirFrame(records, "TEST", file.container);
}

std::string appSegment(std::uint8_t marker, const std::string& payload) {
  return simulate::jpegSegment(marker, payload);
}

std::string exifSegment(const std::string& make, const std::string& model) {
  std::string tiff("MM\0*\0\0\0\x08\0\x02", 10);
  const std::pair<std::uint16_t, std::string> tags[] = {{0x010F, make}, {0x0110, model}};
  std::string texts;
  for (const auto& [tag, text] : tags) {
    append(tiff, tag, ByteOrder::big);
    append(tiff, std::uint16_t{2}, ByteOrder::big);
    append(tiff, std::uint32_t{64}, ByteOrder::big);
    append(tiff, static_cast<std::uint32_t>(8 + 2 + 24 + 4 + texts.size()), ByteOrder::big);
    texts += text + std::string(64 - text.size(), '\0');
  }
  tiff += std::string(4, '\0') + texts;
  return appSegment(0xE1, std::string("Exif\0\0", 6) + tiff);
}

std::string radiometricJpeg(const std::string& frame, const JpegCut& cut) {
  std::vector<std::string> segments =
      simulate::flirSegments(frame, {.piece_size = cut.piece_size, .numbered = cut.numbered});
  if (cut.shuffled) std::rotate(segments.begin(), segments.end() - 1, segments.end());
  std::string jpeg("\xFF\xD8");
  jpeg += cut.before;
  for (const std::string& segment : segments) jpeg += segment;
  return jpeg + "\xFF\xDA" + std::string(20, 'x') + "\xFF\xD9";
}

std::string zlibbed(const std::string& data) {
  libdeflate_compressor* compressor = libdeflate_alloc_compressor(6);
  std::string packed(libdeflate_zlib_compress_bound(compressor, data.size()), '\0');
  packed.resize(libdeflate_zlib_compress(compressor, data.data(), data.size(), packed.data(), packed.size()));
  libdeflate_free_compressor(compressor);
  return packed;
}

std::string grey16Png(int width, int height, const std::vector<std::uint16_t>& samples) {
  std::string header;
  append(header, static_cast<std::uint32_t>(width), ByteOrder::big);
  append(header, static_cast<std::uint32_t>(height), ByteOrder::big);
  header += std::string("\x10\0\0\0\0", 5);
  const std::size_t stride = 2 * static_cast<std::size_t>(width);
  const std::string bytes = inOrder(samples, ByteOrder::big);
  std::string above(stride, '\0');
  std::string data;
  for (int v = 0; v < height; ++v) {
    const std::string row = bytes.substr(static_cast<std::size_t>(v) * stride, stride);
    data += filtered(row, above, v % 5);
    above = row;
  }
  const std::string packed = zlibbed(data);
  std::string png = "\x89PNG\r\n\x1A\n" + pngChunk("IHDR", header);
  for (std::size_t i = 0; i < packed.size(); i += 8192) png += pngChunk("IDAT", packed.substr(i, 8192));
  return png + pngChunk("IEND", "");
}

std::string jpegLs(int width, int height, const std::vector<std::uint16_t>& samples) {
  charls::jpegls_encoder encoder;
  encoder.frame_info({static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), 16, 1});
  std::string bytes(encoder.estimated_destination_size(), '\0');
  encoder.destination(bytes);
  bytes.resize(encoder.encode(samples));
  return bytes;
}

}  // namespace thermovox::test
