#include "mapping/mission_report.hpp"

namespace thermovox {
namespace {

constexpr std::array kDroppedNames{"no_return", "too_near",          "too_far",          "too_weak",
                                   "bad_time",  "before_trajectory", "after_trajectory", "trajectory_gap"};
constexpr std::array kUncolouredNames{"no_camera",     "no_frame", "no_pose_for_frame",
                                      "outside_image", "hidden",   "unknown_pixel"};

template <typename Reason, std::size_t kReasons>
std::map<std::string, std::size_t> named(const ReasonCounts<Reason, kReasons>& counts,
                                         const std::array<const char*, kReasons>& names) {
  std::map<std::string, std::size_t> result;
  for (std::size_t i = 0; i < kReasons; ++i) {
    const std::size_t n = counts.of(static_cast<Reason>(i));
    if (n > 0) result[names[i]] = n;
  }
  return result;
}

}  // namespace

std::map<std::string, std::size_t> namedCounts(const DroppedCounts& counts) {
  return named(counts, kDroppedNames);
}

std::map<std::string, std::size_t> namedCounts(const UncolouredCounts& counts) {
  return named(counts, kUncolouredNames);
}

}  // namespace thermovox
