#include "io/byte_source.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "io/input_file.hpp"
#include "projection/error.hpp"

namespace thermovox {

ByteSource::ByteSource(const std::filesystem::path& file, std::string_view named_by)
    : name_(file.string()), file_(openInput(file, named_by)) {
  file_.seekg(0, std::ios::end);
  const std::streamoff end = file_.tellg();
  if (end < 0) throw DataError(name_ + ": reading failed: " + std::strerror(errno));
  size_ = static_cast<std::uint64_t>(end);
}

ByteSource::ByteSource(std::span<const std::byte> bytes, std::string name)
    : name_(std::move(name)), size_(bytes.size()), bytes_(bytes) {}

std::vector<std::byte> ByteSource::read(std::uint64_t place, std::uint64_t count) {
  const std::uint64_t there = std::min(count, size_ - std::min(place, size_));
  if (there == 0) return {};
  if (!file_.is_open()) {
    const auto piece = bytes_.subspan(place, there);
    return {piece.begin(), piece.end()};
  }
  std::vector<std::byte> bytes(there);
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(place));
  file_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(there));
  if (file_.bad()) throw DataError(name_ + ": reading failed: " + std::strerror(errno));
  bytes.resize(static_cast<std::size_t>(file_.gcount()));
  return bytes;
}

}  // namespace thermovox
