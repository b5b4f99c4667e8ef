#include "io/exif.hpp"

#include <cstdint>

#include "io/byte_order.hpp"

namespace thermovox {
namespace {

constexpr std::uint16_t kText = 2;  // the type of a tag
constexpr std::size_t kEntrySize = 12;
constexpr std::size_t kLongestText = 256;

/// The text of a directory entry: in the entry where it fits into four bytes, else where the entry points to.
std::string entryText(std::span<const std::byte> tiff, std::size_t entry, ByteOrder order) {
  const auto type = numberAt<std::uint16_t>(tiff, entry + 2, order);
  const auto count = numberAt<std::uint32_t>(tiff, entry + 4, order);
  const auto offset = numberAt<std::uint32_t>(tiff, entry + 8, order);
  if (!offset || type != kText) return "";
  return textAt(tiff, *count > 4 ? *offset : entry + 8, *count < kLongestText ? *count : kLongestText);
}

}  // namespace

ExifFacts exifFacts(std::span<const std::byte> tiff) {
  ExifFacts facts;
  const ByteOrder order = beginsWith(tiff, "MM") ? ByteOrder::big : ByteOrder::little;
  const auto directory = numberAt<std::uint32_t>(tiff, 4, order);
  if (!directory) return facts;
  const std::size_t entries = numberAt<std::uint16_t>(tiff, *directory, order).value_or(0);
  for (std::size_t i = 0; i < entries; ++i) {
    const std::size_t entry = *directory + 2 + i * kEntrySize;
    const auto tag = numberAt<std::uint16_t>(tiff, entry, order);
    if (!tag) break;
    if (tag == 0x010F) facts.make = entryText(tiff, entry, order);
    if (tag == 0x0110) facts.model = entryText(tiff, entry, order);
    if (tag == 0x0131) facts.software = entryText(tiff, entry, order);
    if (tag == 0x0132) facts.time = entryText(tiff, entry, order);
  }
  return facts;
}

}  // namespace thermovox
