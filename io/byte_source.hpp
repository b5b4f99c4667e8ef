#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace thermovox {

/// The bytes of a file, read where they are wanted, or bytes in memory that outlive it.
class ByteSource {
 public:
  /// Throws DataError as openInput() does.
  explicit ByteSource(const std::filesystem::path& file, std::string_view named_by = {});
  ByteSource(std::span<const std::byte> bytes, std::string name);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Up to `count` bytes from a place on; fewer where the file ends. Throws DataError when reading fails.
  [[nodiscard]] std::vector<std::byte> read(std::uint64_t place, std::uint64_t count);

 private:
  std::string name_;
  std::uint64_t size_ = 0;
  std::ifstream file_;
  std::span<const std::byte> bytes_;
};

}  // namespace thermovox
