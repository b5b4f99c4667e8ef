#include "apps/simulate/capture_rig.hpp"

#include "apps/simulate/mounting.hpp"
#include "apps/simulate/random.hpp"

namespace thermovox::simulate {
namespace {

/// The numbers of one stream come in the order in which they are asked for: items of it that must not depend
/// on each other have an index of their own.
enum RigPart : std::uint64_t { kThermalPart, kVisiblePart, kLaserPart, kGuessPart };

Random randomOf(const CaptureOptions& options, RigPart part) {
  return {options.seed, RandomStream::capture_rig, part};
}

/// value, off by up to `spread` either way.
double around(double value, double spread, Random& random) {
  return value + random.uniform(-spread, spread);
}

Intrinsics imageOf(int width_px, int height_px) {
  Intrinsics in;
  in.width_px = width_px;
  in.height_px = height_px;
  in.model = LensModel::brown_conrady;
  return in;
}

Intrinsics trueThermal(Random& random) {
  Intrinsics in = imageOf(160, 120);
  in.parameters[kFx] = around(149.2, 2.0, random);
  in.parameters[kFy] = in.parameters[kFx] * around(0.996, 0.004, random);
  in.parameters[kCx] = around(79.5, 1.5, random);
  in.parameters[kCy] = around(59.5, 1.5, random);
  const double k1 = around(-0.24, 0.02, random);
  const double k2 = around(0.09, 0.01, random);
  const double p1 = around(0.0, 0.001, random);
  const double p2 = around(0.0, 0.001, random);
  return withDistortion(in, {k1, k2, p1, p2, 0.0});
}

Intrinsics trueVisible(Random& random) {
  Intrinsics in = imageOf(1920, 1080);
  in.parameters[kFx] = around(1515.0, 15.0, random);
  in.parameters[kFy] = in.parameters[kFx] * around(0.998, 0.002, random);
  in.parameters[kCx] = around(959.5, 10.0, random);
  in.parameters[kCy] = around(539.5, 10.0, random);
  const double k1 = around(0.03, 0.01, random);
  const double k2 = around(-0.06, 0.01, random);
  const double p1 = around(0.0, 0.0005, random);
  const double p2 = around(0.0, 0.0005, random);
  return withDistortion(in, {k1, k2, p1, p2, 0.0});
}

/// By the data sheet: the focal length of both axes, the image's middle, no distortion.
Camera nominal(int width_px, int height_px, double focal_px) {
  Intrinsics in = imageOf(width_px, height_px);
  in.parameters = {focal_px, focal_px, 0.5 * (width_px - 1), 0.5 * (height_px - 1)};
  return Camera(withDistortion(in, {0.0, 0.0, 0.0, 0.0, 0.0}));
}

/// R' = Exp(w) R, t' = t + v with w and v along the body's axes.
Pose moved(const Pose& pose, double rotation_sigma, double translation_sigma, Random& random) {
  const Eigen::Vector3d w = rotation_sigma * random.normal3();
  const Eigen::Vector3d v = translation_sigma * random.normal3();
  return {(expRotation(w) * pose.rotation).normalized(), pose.translation + v};
}

/// Beside the thermal camera and looking the same way, as the drawing has it.
Pose visibleByDrawing(const ThermalCamera& thermal) {
  return {thermal.T_body_camera.rotation, thermal.T_body_camera.translation - Eigen::Vector3d(0, 0.014, 0)};
}

ThermalCamera trueThermalCamera(const CaptureOptions& options) {
  Random random = randomOf(options, kThermalPart);
  const Intrinsics in = trueThermal(random);
  const Pose level{lookingAhead(), {0.10, -0.02, -0.04}};
  ThermalCamera thermal{Camera(in), moved(level, 0.8 * kDegree, 0.0, random)};
  thermal.t_linear = TLinear{};
  thermal.netd = options.netd;
  thermal.blur_px = options.blur_px;
  thermal.knows_blur = true;
  return thermal;
}

Laser trueLaser(const CaptureOptions& options) {
  Random random = randomOf(options, kLaserPart);
  Laser laser;
  laser.kind = options.laser;
  laser.T_body_laser = moved({Eigen::Quaterniond::Identity(), {0.09, 0.05, 0.045}}, kDegree, 0.005, random);
  laser.range_min = 0.05;
  laser.range_max = 40.0;
  laser.range_sigma = options.range_sigma;
  laser.angle_min = -135.0 * kDegree;
  laser.angle_increment = 0.25 * kDegree;
  return laser;
}

}  // namespace

Rig drawTrueRig(const CaptureOptions& options) {
  Random random = randomOf(options, kVisiblePart);
  Rig rig;
  rig.thermal_camera = trueThermalCamera(options);
  const Intrinsics visible = trueVisible(random);
  const Pose drawing = visibleByDrawing(*rig.thermal_camera);
  rig.visible_camera = MountedCamera{Camera(visible), moved(drawing, 0.2 * kDegree, 0.001, random)};
  rig.lasers.push_back(trueLaser(options));
  return rig;
}

Rig drawGuessedRig(const CaptureOptions& options, const Rig& true_rig) {
  Random random = randomOf(options, kGuessPart);
  Rig rig = true_rig;
  rig.thermal_camera->camera = nominal(160, 120, 147.0);
  rig.visible_camera->camera = nominal(1920, 1080, 1500.0);
  rig.visible_camera->T_body_camera = visibleByDrawing(*rig.thermal_camera);
  Laser& laser = rig.lasers.front();
  laser.T_body_laser =
      moved(laser.T_body_laser, options.guess.rotation_sigma, options.guess.translation_sigma, random);
  return rig;
}

}  // namespace thermovox::simulate
