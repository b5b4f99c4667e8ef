#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/byte_order.hpp"

namespace thermovox {

/// What the records of a FLIR frame hold that thermovox reads.
enum class FlirRecordType : std::uint16_t {
  raw_data = 0x01,
  embedded_image = 0x0E,
  camera_info = 0x20,
  picture_in_picture = 0x2A,
};

/// A record of a frame: a piece of its bytes.
struct FlirRecord {
  std::uint16_t type = 0;
  std::uint16_t subtype = 0;
  std::size_t offset = 0;  ///< from the frame's first byte
  std::size_t size = 0;    ///< bytes
};

/// Size of the header, and of each entry of the directory behind it, bytes.
inline constexpr std::size_t kFlirHeaderSize = 64;
inline constexpr std::size_t kFlirEntrySize = 32;

/// The header of a FLIR frame (FFF, of FLIR's cameras, and AFF): where its directory of records is. All its
/// numbers are in one byte order, told by the version being from 100 to 199 in it.
struct FlirHeader {
  ByteOrder order = ByteOrder::little;
  std::string creator;
  std::uint32_t directory_offset = 0;
  std::uint32_t entries = 0;
};

/// nullopt where no such header begins.
[[nodiscard]] std::optional<FlirHeader> parseFlirHeader(std::span<const std::byte> bytes);

/// The records that a directory names; its empty entries are left out. `bytes` are those of the directory.
[[nodiscard]] std::vector<FlirRecord> parseFlirDirectory(std::span<const std::byte> bytes,
                                                         const FlirHeader& header);

/// Bytes from the frame's first to the last of what its directory names.
[[nodiscard]] std::uint64_t flirFrameSize(const FlirHeader& header, std::span<const FlirRecord> records);

/// One frame in memory. The bytes must outlive it.
class FlirFrame {
 public:
  /// `name` stands for the frame in messages. Throws DataError when no frame begins there or its directory is
  /// cut off.
  FlirFrame(std::span<const std::byte> bytes, std::string name);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& creator() const { return header_.creator; }
  /// The first record of a type; nullopt where there is none.
  [[nodiscard]] std::optional<FlirRecord> find(FlirRecordType type) const;
  /// As many of its bytes as there are.
  [[nodiscard]] std::span<const std::byte> bytesThere(const FlirRecord& record) const;
  /// Its bytes. Throws DataError, naming the record by `what`, when the frame ends before it.
  [[nodiscard]] std::span<const std::byte> bytesOf(const FlirRecord& record, const std::string& what) const;

 private:
  std::span<const std::byte> bytes_;
  std::string name_;
  FlirHeader header_;
  std::vector<FlirRecord> records_;
};

}  // namespace thermovox
