#include "io/flir_frame.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "projection/error.hpp"

namespace thermovox {
namespace {

/// Cameras write 6 to 50 records.
constexpr std::uint32_t kMostEntries = 10'000;

}  // namespace

std::optional<FlirHeader> parseFlirHeader(std::span<const std::byte> bytes) {
  using namespace std::string_view_literals;
  if (bytes.size() < kFlirHeaderSize) return std::nullopt;
  if (!beginsWith(bytes, "FFF\0"sv) && !beginsWith(bytes, "AFF\0"sv)) return std::nullopt;
  for (const ByteOrder order : {ByteOrder::big, ByteOrder::little}) {
    const std::uint32_t version = *numberAt<std::uint32_t>(bytes, 0x14, order);
    const std::uint32_t entries = *numberAt<std::uint32_t>(bytes, 0x1C, order);
    if (version < 100 || version > 199 || entries > kMostEntries) continue;
    return FlirHeader{order, textAt(bytes, 4, 16), *numberAt<std::uint32_t>(bytes, 0x18, order), entries};
  }
  return std::nullopt;
}

std::vector<FlirRecord> parseFlirDirectory(std::span<const std::byte> bytes, const FlirHeader& header) {
  std::vector<FlirRecord> records;
  for (std::size_t place = 0; place + kFlirEntrySize <= bytes.size(); place += kFlirEntrySize) {
    const FlirRecord record{*numberAt<std::uint16_t>(bytes, place, header.order),
                            *numberAt<std::uint16_t>(bytes, place + 2, header.order),
                            *numberAt<std::uint32_t>(bytes, place + 12, header.order),
                            *numberAt<std::uint32_t>(bytes, place + 16, header.order)};
    if (record.type != 0 && record.size > 0) records.push_back(record);
  }
  return records;
}

std::uint64_t flirFrameSize(const FlirHeader& header, std::span<const FlirRecord> records) {
  std::uint64_t size =
      std::max<std::uint64_t>(kFlirHeaderSize, std::uint64_t{header.directory_offset} +
                                                   std::uint64_t{header.entries} * kFlirEntrySize);
  for (const FlirRecord& record : records) size = std::max<std::uint64_t>(size, record.offset + record.size);
  return size;
}

FlirFrame::FlirFrame(std::span<const std::byte> bytes, std::string name)
    : bytes_(bytes), name_(std::move(name)) {
  const std::optional<FlirHeader> header = parseFlirHeader(bytes);
  if (!header) throw DataError(name_ + ": holds no FLIR frame of a known version (FFF 100 to 199)");
  header_ = *header;
  const std::uint64_t size = std::uint64_t{header_.entries} * kFlirEntrySize;
  if (header_.directory_offset > bytes.size() || bytes.size() - header_.directory_offset < size) {
    throw DataError(name_ + ": the FLIR frame is cut off after " + std::to_string(bytes.size()) +
                    " bytes, expected a directory of " + std::to_string(header_.entries) +
                    " records at byte " + std::to_string(header_.directory_offset));
  }
  records_ = parseFlirDirectory(bytes.subspan(header_.directory_offset, size), header_);
}

std::optional<FlirRecord> FlirFrame::find(FlirRecordType type) const {
  const auto found = std::find_if(records_.begin(), records_.end(), [type](const FlirRecord& record) {
    return record.type == static_cast<std::uint16_t>(type);
  });
  return found == records_.end() ? std::nullopt : std::optional(*found);
}

std::span<const std::byte> FlirFrame::bytesThere(const FlirRecord& record) const {
  const std::size_t begin = std::min(record.offset, bytes_.size());
  return bytes_.subspan(begin, std::min(record.size, bytes_.size() - begin));
}

std::span<const std::byte> FlirFrame::bytesOf(const FlirRecord& record, const std::string& what) const {
  const std::span<const std::byte> bytes = bytesThere(record);
  if (bytes.size() < record.size) {
    throw DataError(name_ + ": the FLIR frame is cut off after " + std::to_string(bytes_.size()) +
                    " bytes, expected " + what + " up to byte " +
                    std::to_string(record.offset + record.size));
  }
  return bytes;
}

}  // namespace thermovox
