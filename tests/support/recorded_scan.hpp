#pragma once

#include <bzlib.h>

#include <sstream>
#include <vector>

#include "mapping/thermal_map.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox::test {

/// The content of a .bz2 file.
[[nodiscard]] inline std::string decompressed(const std::filesystem::path& file) {
  std::string packed = bytesOf(file);
  std::string content(std::size_t{64} << 20, '\0');
  auto size = static_cast<unsigned>(content.size());
  if (BZ2_bzBuffToBuffDecompress(content.data(), &size, packed.data(), static_cast<unsigned>(packed.size()),
                                 0, 0) != BZ_OK) {
    throw std::runtime_error("cannot decompress " + file.string());
  }
  content.resize(size);
  return content;
}

/// OctoMap's sample scan as one reading from the origin. Precondition: the recordings are there.
[[nodiscard]] inline std::vector<MappedReturn> recordedScan() {
  std::istringstream text(decompressed(*recordings() / "laser/octomap/scan.dat.bz2"));
  std::vector<MappedReturn> reading;
  for (float x, y, z; text >> x >> y >> z;) {
    reading.push_back({{x, y, z}, Eigen::Vector3d::Zero(), Time{}, std::nullopt});
  }
  return reading;
}

}  // namespace thermovox::test
