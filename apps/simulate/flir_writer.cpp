#include "apps/simulate/flir_writer.hpp"

#include <bit>
#include <cmath>
#include <type_traits>
#include <utility>

namespace thermovox::simulate {
namespace {

constexpr std::size_t kPixelOffset = 32;
constexpr std::size_t kPictureInPictureSize = 96;
constexpr std::uint32_t kVersion = 101;

/// Bytes, all zero at first, into which numbers and texts are put.
class Bytes {
 public:
  Bytes(std::size_t size, ByteOrder order) : order_(order), bytes_(size, '\0') {}

  /// Leaves out what ends behind the last byte.
  template <typename Number>
  void put(std::size_t offset, Number number) {
    if (offset + sizeof(Number) > bytes_.size()) return;
    std::uint64_t bits = 0;
    if constexpr (std::is_same_v<Number, float>) {
      bits = std::bit_cast<std::uint32_t>(number);
    } else {
      static_assert(std::is_integral_v<Number>);
      bits = static_cast<std::uint64_t>(number);
    }
    for (std::size_t i = 0; i < sizeof(Number); ++i) {
      const std::size_t place = order_ == ByteOrder::little ? i : sizeof(Number) - 1 - i;
      bytes_[offset + place] = static_cast<char>(bits >> 8 * i);
    }
  }
  void putReal(std::size_t offset, double number) { put(offset, static_cast<float>(number)); }
  void putKelvin(std::size_t offset, double celsius) { putReal(offset, celsius - kAbsoluteZero); }
  void putText(std::size_t offset, std::string_view text) {
    if (offset + text.size() <= bytes_.size()) bytes_.replace(offset, text.size(), text);
  }
  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  ByteOrder order_;
  std::string bytes_;
};

void putParameters(Bytes& record, const RadiometricParameters& of) {
  record.putReal(0x20, of.emissivity);
  record.putReal(0x24, of.distance);
  record.putKelvin(0x28, of.reflected);
  record.putKelvin(0x2C, of.atmosphere_temperature);
  record.putKelvin(0x30, of.window_temperature);
  record.putReal(0x34, of.window_transmission);
  record.putReal(0x3C, of.humidity);
  record.putReal(0x58, of.planck.r1);
  record.putReal(0x5C, of.planck.b);
  record.putReal(0x60, of.planck.f);
  record.putReal(0x70, of.atmosphere.alpha1);
  record.putReal(0x74, of.atmosphere.alpha2);
  record.putReal(0x78, of.atmosphere.beta1);
  record.putReal(0x7C, of.atmosphere.beta2);
  record.putReal(0x80, of.atmosphere.x);
  record.put(0x308, static_cast<std::int32_t>(std::lround(of.planck.o)));
  record.putReal(0x30C, of.planck.r2);
}

}  // namespace

std::string flirPixelRecord(int width, int height, std::string_view pixels, ByteOrder order) {
  Bytes record(kPixelOffset, order);
  record.put(0, std::uint16_t{2});
  record.put(2, static_cast<std::uint16_t>(width));
  record.put(4, static_cast<std::uint16_t>(height));
  return record.take().append(pixels);
}

std::string flirCameraRecord(const WrittenCamera& camera, std::size_t size, ByteOrder order) {
  Bytes record(size, order);
  record.put(0, std::uint16_t{2});
  putParameters(record, camera.parameters);
  record.putKelvin(0x90, camera.range_high);
  record.putKelvin(0x94, camera.range_low);
  record.putText(0xD4, camera.model);
  record.putText(0x104, camera.serial);
  record.putText(0x170, camera.lens);
  record.putReal(0x1B4, camera.field_of_view_deg);
  record.put(0x384, camera.unix_seconds);
  record.put(0x388, camera.milliseconds);
  record.put(0x38C, camera.minutes_behind);
  return record.take();
}

std::string flirPictureInPictureRecord(float real_to_ir, const std::vector<std::int16_t>& rest) {
  Bytes record(kPictureInPictureSize, ByteOrder::little);
  record.put(0, real_to_ir);
  for (std::size_t i = 0; i < rest.size(); ++i) record.put(4 + 2 * i, rest[i]);
  return record.take();
}

std::string flirFrame(const std::vector<WrittenRecord>& records, std::string_view creator, ByteOrder order) {
  std::size_t end = kFlirHeaderSize + records.size() * kFlirEntrySize;
  Bytes header(end, order);
  header.putText(0, std::string_view("FFF\0", 4));
  header.putText(0x04, creator);
  header.put(0x14, kVersion);
  header.put(0x18, static_cast<std::uint32_t>(kFlirHeaderSize));
  header.put(0x1C, static_cast<std::uint32_t>(records.size()));
  std::string bytes;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const std::size_t entry = kFlirHeaderSize + i * kFlirEntrySize;
    header.put(entry, records[i].type);
    header.put(entry + 2, records[i].subtype);
    header.put(entry + 4, kVersion);
    header.put(entry + 12, static_cast<std::uint32_t>(end));
    header.put(entry + 16, static_cast<std::uint32_t>(records[i].bytes.size()));
    bytes += records[i].bytes;
    end += records[i].bytes.size();
  }
  return header.take() + bytes;
}

std::vector<std::string> flirSegments(std::string_view frame, const FlirCut& cut) {
  const std::size_t pieces = (frame.size() + cut.piece_size - 1) / cut.piece_size;
  std::vector<std::string> segments;
  for (std::size_t i = 0; i < pieces; ++i) {
    std::string payload("FLIR\0\x01", 6);
    payload += static_cast<char>(cut.numbered ? i : 0);
    payload += static_cast<char>(cut.numbered ? pieces - 1 : 0);
    payload += frame.substr(i * cut.piece_size, cut.piece_size);
    segments.push_back(jpegSegment(0xE1, payload));
  }
  return segments;
}

std::string jpegSegment(std::uint8_t marker, std::string_view payload) {
  const std::size_t length = payload.size() + 2;  // with the length itself
  std::string segment{'\xFF', static_cast<char>(marker), static_cast<char>(length >> 8),
                      static_cast<char>(length)};
  return segment.append(payload);
}

}  // namespace thermovox::simulate
