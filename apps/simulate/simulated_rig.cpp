#include "apps/simulate/simulated_rig.hpp"

#include "apps/simulate/mounting.hpp"

namespace thermovox::simulate {
namespace {

Intrinsics makeIntrinsics(LensModel lens) {
  Intrinsics in;
  in.width_px = 160;
  in.height_px = 120;
  in.model = lens;
  in.parameters = {150.7, 150.2, 80.4, 58.6};
  switch (lens) {
    case LensModel::brown_conrady:
      return withDistortion(in, {-0.232, 0.084, -0.0009, 0.0011, 0.0});
    case LensModel::kannala_brandt:  // a wider lens: 84 degrees across
      in.parameters[kFx] = 108.4;
      in.parameters[kFy] = 108.1;
      return withDistortion(in, {0.031, -0.012, 0.004, -0.0011});
    case LensModel::pinhole:
      break;
  }
  return in;
}

Laser makeLaser(const SimulationOptions& options) {
  Laser laser;
  laser.kind = options.laser;
  laser.T_body_laser = {rollPitchYaw(-0.4, 0.7, 0.9), {0.09, 0.05, 0.07}};
  laser.range_sigma = options.range_sigma;
  laser.range_bias_sigma = options.errors.range_bias_sigma;
  laser.covariance_body_laser = options.errors.covariance_body_laser;
  switch (options.laser) {
    case LaserKind::beam:
      laser.range_min = 0.05;
      laser.range_max = 40.0;
      break;
    case LaserKind::scan:
      laser.range_min = 0.1;
      laser.range_max = 30.0;
      laser.angle_min = -135.0 * kDegree;
      laser.angle_increment = 0.25 * kDegree;
      // 1440 steps a turn, of which the scanner measures 1081.
      laser.time_increment = durationFromSeconds(1.0 / (options.scan_rate * 1440.0));
      break;
    case LaserKind::cloud:
      laser.range_min = 0.3;
      laser.range_max = 60.0;
      laser.min_intensity = 100.0;
      break;
  }
  return laser;
}

/// The kind of a phone's: 640 x 480, 68 degrees across, 5 cm beside the thermal camera.
MountedCamera makeVisibleCamera() {
  Intrinsics in;
  in.width_px = 640;
  in.height_px = 480;
  in.model = LensModel::brown_conrady;
  in.parameters = {472.3, 471.6, 322.1, 236.8};
  const Eigen::Quaterniond mount = rollPitchYaw(-0.5, 0.4, 0.7);
  return {Camera(withDistortion(in, {-0.118, 0.041, 0.0006, -0.0004, 0.0})),
          {(mount * lookingAhead()).normalized(), {0.12, 0.01, -0.02}}};
}

}  // namespace

double cloudElevation(int beam) {
  return (-15.0 + 30.0 * beam / (kCloudBeams - 1)) * kDegree;
}

RadiometricParameters makeRadiometry(const SimulationOptions& options) {
  RadiometricParameters parameters;
  // 0.01 C a count at room temperature, 288 C at the last one.
  parameters.planck = {.r1 = 34000.0, .r2 = 0.0442, .b = 1428.0, .f = 1.0, .o = -140.0};
  parameters.emissivity = options.emissivity;
  parameters.distance = 1.0;
  parameters.reflected = options.reflected.value_or(options.air);
  parameters.atmosphere_temperature = options.air;
  parameters.humidity = options.humidity;
  parameters.window_transmission = options.window_transmission;
  parameters.window_temperature = options.window_temperature.value_or(options.air);
  return parameters;
}

Rig makeRig(const SimulationOptions& options) {
  const Eigen::Quaterniond mount = rollPitchYaw(0.8, -0.6, -1.1);
  ThermalCamera thermal{Camera(makeIntrinsics(options.lens)),
                        {(mount * lookingAhead()).normalized(), {0.11, -0.04, -0.03}}};
  thermal.t_linear = TLinear{};
  thermal.netd = options.netd;
  thermal.blur_px = options.blur_px;
  thermal.knows_blur = true;
  thermal.bias_sigma = options.errors.camera_bias_sigma;
  Rig rig;
  rig.thermal_camera = thermal;
  if (options.visible == SimulationOptions::VisibleCamera::present) rig.visible_camera = makeVisibleCamera();
  rig.lasers.push_back(makeLaser(options));
  return rig;
}

}  // namespace thermovox::simulate
