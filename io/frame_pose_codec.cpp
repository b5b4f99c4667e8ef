#include "io/frame_pose_codec.hpp"

#include <cmath>

#include "io/little_endian.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr std::size_t kRowBytes = 64;
constexpr double kNormSlack = 1e-6;  // of a unit quaternion

}  // namespace

std::string encodeFramePoses(const std::vector<FramePose>& frames) {
  std::string bytes;
  bytes.reserve(frames.size() * kRowBytes);
  for (const FramePose& frame : frames) {
    appendLittleEndian(bytes, std::int64_t{frame.stamp.time_since_epoch().count()});
    for (int i = 0; i < 3; ++i) appendLittleEndian(bytes, frame.T_world_camera.translation[i]);
    for (int i = 0; i < 4; ++i) appendLittleEndian(bytes, frame.T_world_camera.rotation.coeffs()[i]);
  }
  return bytes;
}

std::vector<FramePose> decodeFramePoses(std::string_view bytes) {
  if (bytes.size() % kRowBytes != 0) {
    throw DataError("the frames of a mission have " + std::to_string(bytes.size()) +
                    " bytes, expected a multiple of " + std::to_string(kRowBytes));
  }
  LittleEndianReader reader(bytes);
  std::vector<FramePose> frames(bytes.size() / kRowBytes);
  for (FramePose& frame : frames) {
    frame.stamp = Time(Duration(*reader.next<std::int64_t>()));
    for (int i = 0; i < 3; ++i) frame.T_world_camera.translation[i] = *reader.next<double>();
    for (int i = 0; i < 4; ++i) frame.T_world_camera.rotation.coeffs()[i] = *reader.next<double>();
    const bool is_pose = frame.T_world_camera.translation.allFinite() &&
                         std::abs(frame.T_world_camera.rotation.norm() - 1.0) < kNormSlack;
    if (!is_pose) throw DataError("the frames of a mission hold a pose that is none");
  }
  return frames;
}

}  // namespace thermovox
