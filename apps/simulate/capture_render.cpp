#include "apps/simulate/capture_render.hpp"

#include <algorithm>
#include <cmath>

#include "apps/simulate/random.hpp"

namespace thermovox::simulate {
namespace {

constexpr int kThermalCells = 3;       // a pixel and axis: the blur is narrow
constexpr double kVisibleBlur = 0.6;   // px
constexpr double kVisibleNoise = 1.5;  // of 255

constexpr double kRoom = 21.8;              // C, of the room and of what the board mirrors
constexpr double kHeated = 20.0;            // C over the room, of the board where it is hottest
constexpr double kEmissivity = 0.95;        // of the light squares
constexpr double kMarginEmissivity = 0.90;  // of the plate around the squares

/// How hot the board is at a place, of 1 where it is hottest: a lamp's bell upon an even warmth.
float warmthAt(const Eigen::Vector2f& place) {
  const float distance2 = (place - Eigen::Vector2f(0.03F, -0.02F)).squaredNorm();
  return 0.8F + 0.2F * std::exp(-distance2 / (2.0F * 0.15F * 0.15F));
}

/// A surface of emissivity e shows e T + (1 - e) room, nearly enough over 20 degrees.
BoardPaint thermalPaint(const CaptureOptions& options) {
  const auto risen = [](double emissivity) { return static_cast<float>(emissivity * kHeated); };
  const std::array<float, 4> rise{0.0F, risen(kMarginEmissivity),
                                  risen(kEmissivity - options.contrast / kHeated), risen(kEmissivity)};
  return [rise](BoardPart part, const Eigen::Vector2f& place) {
    if (part == BoardPart::surroundings) return static_cast<float>(kRoom);
    return static_cast<float>(kRoom) + rise[static_cast<std::size_t>(part)] * warmthAt(place);
  };
}

/// Light from the upper left.
float greyOf(BoardPart part, const Eigen::Vector2f& place) {
  constexpr std::array<float, 4> kGrey{90.0F, 200.0F, 30.0F, 222.0F};
  const float grey = kGrey[static_cast<std::size_t>(part)];
  if (part == BoardPart::surroundings) return grey;
  return grey * (1.0F - 0.2F * (place.x() + place.y()));
}

}  // namespace

CaptureRenderer::CaptureRenderer(const CaptureScene& scene)
    : scene_(scene),
      thermal_(scene.trueRig().thermal_camera->camera, kThermalCells, scene.options().blur_px,
               scene.options().threads),
      visible_(scene.trueRig().visible_camera->camera, 1, kVisibleBlur, scene.options().threads) {}

std::vector<std::uint16_t> CaptureRenderer::thermalCounts(std::size_t capture) const {
  const ThermalCamera& camera = *scene_.trueRig().thermal_camera;
  const Pose T_camera_board = camera.T_body_camera.inverse() * scene_.captures().at(capture).T_body_board;
  const CaptureOptions& options = scene_.options();
  Random noise(options.seed, RandomStream::thermal_noise, capture);
  std::vector<std::uint16_t> counts;
  for (const float celsius : thermal_.render(scene_.board(), T_camera_board, thermalPaint(options))) {
    const double shown = celsius + options.netd * noise.normal() - camera.t_linear->celsius_offset;
    counts.push_back(static_cast<std::uint16_t>(
        std::clamp(std::round(shown / camera.t_linear->celsius_per_count), 1.0, 65535.0)));
  }
  return counts;
}

std::vector<std::uint8_t> CaptureRenderer::luminance(std::size_t capture) const {
  const MountedCamera& camera = *scene_.trueRig().visible_camera;
  const Pose T_camera_board = camera.T_body_camera.inverse() * scene_.captures().at(capture).T_body_board;
  Random noise(scene_.options().seed, RandomStream::visible_noise, capture);
  const std::vector<float> grey = visible_.render(scene_.board(), T_camera_board, greyOf);
  std::vector<std::uint8_t> luminance;
  luminance.reserve(grey.size());
  for (const float value : grey)
    luminance.push_back(static_cast<std::uint8_t>(
        std::clamp(std::round(value + kVisibleNoise * noise.normal()), 0.0, 255.0)));
  return luminance;
}

}  // namespace thermovox::simulate
