#include "io/spilled_tiles.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "io/folders.hpp"
#include "io/tile_codec.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr std::uint64_t kPage = 4096;

/// Room for so many bytes: pages, and of many a multiple of an eighth of the next power of two, so that
/// tiles that grow a little find the room that others left. At most an eighth is wasted.
std::uint64_t roomFor(std::uint64_t size) {
  const std::uint64_t step = std::max(kPage, std::bit_ceil(size) / 8);
  return (size + step - 1) / step * step;
}

}  // namespace

SpilledTiles::SpilledTiles(std::filesystem::path folder) : folder_(std::move(folder)) {
  if (folder_.empty()) folder_ = ".";
}

SpilledTiles::~SpilledTiles() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void SpilledTiles::fail(const char* action, int error) const {
  const bool full = error == ENOSPC || error == EDQUOT || error == EFBIG;
  throw DataError(folder_.string() + ": tiles that do not fit into memory cannot be " + action + " here (" +
                  (full ? "the disk is full" : std::strerror(error)) +
                  "), expected room for them or more memory");
}

void SpilledTiles::open() {
  if (descriptor_ >= 0) return;
  descriptor_ = openUnnamedFile(folder_);
  if (descriptor_ < 0) fail("kept", errno);
}

SpilledTiles::Place SpilledTiles::placeFor(std::uint64_t size) {
  const std::uint64_t room = roomFor(size);
  const auto unused = free_.find(room);
  if (unused == free_.end()) return {std::exchange(end_, end_ + room), room, size};
  const Place place{unused->second.back(), room, size};
  unused->second.pop_back();
  if (unused->second.empty()) free_.erase(unused);
  return place;
}

void SpilledTiles::forget(const TileKey& tile) {
  const auto found = places_.find(tile);
  if (found == places_.end()) return;
  free_[found->second.room].push_back(found->second.offset);
  places_.erase(found);
}

void SpilledTiles::put(const TileKey& tile, std::span<const BlockView> blocks) {
  open();
  const std::string bytes = encodeTile(blocks);
  const Place place = placeFor(bytes.size());
  for (std::uint64_t done = 0; done < place.size;) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data() + done, place.size - done,
                                     static_cast<off_t>(place.offset + done));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      const int error = written < 0 ? errno : ENOSPC;
      free_[place.room].push_back(place.offset);
      fail("written", error);
    }
    done += static_cast<std::uint64_t>(written);
  }
  forget(tile);
  places_.emplace(tile, place);
}

std::optional<TileBlocks> SpilledTiles::get(const TileKey& tile) const {
  const auto found = places_.find(tile);
  if (found == places_.end()) return std::nullopt;
  std::string bytes(found->second.size, '\0');
  for (std::uint64_t done = 0; done < bytes.size();) {
    const ssize_t read = ::pread(descriptor_, bytes.data() + done, bytes.size() - done,
                                 static_cast<off_t>(found->second.offset + done));
    if (read < 0 && errno == EINTR) continue;
    if (read <= 0) fail("read back", read < 0 ? errno : EIO);
    done += static_cast<std::uint64_t>(read);
  }
  try {
    return decodeTile(tile, bytes);
  } catch (const DataError& error) {
    throw DataError(folder_.string() + ": a tile that did not fit into memory came back damaged (" +
                    error.what() + ")");
  }
}

std::optional<TileBlocks> SpilledTiles::take(const TileKey& tile) {
  std::optional<TileBlocks> blocks = get(tile);
  forget(tile);
  return blocks;
}

std::vector<TileKey> SpilledTiles::sortedTiles() const {
  std::vector<TileKey> tiles;
  tiles.reserve(places_.size());
  for (const auto& [tile, place] : places_) tiles.push_back(tile);
  return tiles;
}

}  // namespace thermovox
