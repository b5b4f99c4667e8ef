#include "io/shared_motion_codec.hpp"

#include <array>
#include <cmath>

#include "io/little_endian.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr std::size_t kFloats = 27;
constexpr std::size_t kRowBytes = 4 * (5 + kFloats);

/// The floats of a motion in the order in which they are kept; `motion` may be const.
auto floatsOf(auto& motion) {
  std::array<decltype(&motion.lever[0]), kFloats> floats{};
  std::size_t next = 0;
  for (auto* matrix : {&motion.by_rotation, &motion.by_translation}) {
    for (int i = 0; i < 9; ++i) floats[next++] = &(*matrix)(i / 3, i % 3);
  }
  for (auto* vector : {&motion.by_range, &motion.lever, &motion.view}) {
    for (int i = 0; i < 3; ++i) floats[next++] = &(*vector)[i];
  }
  return floats;
}

}  // namespace

std::string encodeSharedMotions(const std::vector<SharedMotion>& motions) {
  std::string bytes;
  bytes.reserve(motions.size() * kRowBytes);
  for (const SharedMotion& motion : motions) {
    for (const std::int32_t place : {motion.cube.x, motion.cube.y, motion.cube.z})
      appendLittleEndian(bytes, place);
    appendLittleEndian(bytes, motion.laser);
    appendLittleEndian(bytes, motion.count);
    for (const float* number : floatsOf(motion)) appendLittleEndian(bytes, *number);
  }
  return bytes;
}

std::vector<SharedMotion> decodeSharedMotions(std::string_view bytes) {
  if (bytes.size() % kRowBytes != 0) {
    throw DataError("the shared errors of a mission have " + std::to_string(bytes.size()) +
                    " bytes, expected a multiple of " + std::to_string(kRowBytes));
  }
  LittleEndianReader reader(bytes);
  std::vector<SharedMotion> motions(bytes.size() / kRowBytes);
  for (SharedMotion& motion : motions) {
    for (std::int32_t* place : {&motion.cube.x, &motion.cube.y, &motion.cube.z})
      *place = *reader.next<std::int32_t>();
    motion.laser = *reader.next<std::uint32_t>();
    motion.count = *reader.next<std::uint32_t>();
    if (motion.count == 0) throw DataError("the shared errors of a mission hold means of no returns");
    for (float* number : floatsOf(motion)) {
      *number = *reader.next<float>();
      if (!std::isfinite(*number))
        throw DataError("the shared errors of a mission hold a number that is not finite");
    }
  }
  return motions;
}

}  // namespace thermovox
