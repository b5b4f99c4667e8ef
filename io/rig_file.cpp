#include "io/rig_file.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "io/input_file.hpp"
#include "io/number_text.hpp"
#include "io/unit_quaternion.hpp"
#include "io/yaml_map.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr std::size_t kLargestRigFile = std::size_t{1} << 22;  // bytes; a rig has a few kilobytes

ConfigError fault(const YamlMap& map, std::string_view key, const std::string& what) {
  return ConfigError(map.place(key) + ": " + what);
}

/// The number of a key that must not be negative; without a default the key must be there.
double notNegative(const YamlMap& map, std::string_view key, std::optional<double> otherwise) {
  const double number = otherwise && !map.has(key) ? *otherwise : map.number(key);
  if (number < 0.0) throw fault(map, key, "is " + exactText(number) + ", expected 0 or more");
  return number;
}

Pose readPose(const YamlMap& parent, std::string_view key) {
  const YamlMap map = parent.map(key);
  map.allow({"translation", "quaternion_xyzw"});
  const std::vector<double> t = map.numbers("translation", 3);
  const std::vector<double> q = map.numbers("quaternion_xyzw", 4);
  const std::optional<Eigen::Quaterniond> rotation = unitQuaternion(q[0], q[1], q[2], q[3]);
  if (!rotation) throw fault(map, "quaternion_xyzw", quaternionFault(q[0], q[1], q[2], q[3]));
  return {*rotation, {t[0], t[1], t[2]}};
}

/// A symmetric matrix without negative eigenvalues; both up to what rounding to a few digits does.
Eigen::MatrixXd readCovariance(const YamlMap& map, std::string_view key, Eigen::Index size) {
  constexpr double kRounding = 1e-6;
  const std::vector<double> numbers = map.numbers(key, static_cast<std::size_t>(size * size));
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::MatrixXd matrix = Eigen::Map<const RowMajor>(numbers.data(), size, size);
  if (matrix.diagonal().minCoeff() < 0.0) throw fault(map, key, "has a negative variance on its diagonal");
  // Compared as correlations: the variances of a rotation and of a translation differ by orders of magnitude.
  const Eigen::VectorXd scale =
      matrix.diagonal().cwiseSqrt().unaryExpr([](double sigma) { return sigma > 0.0 ? 1.0 / sigma : 1.0; });
  const Eigen::MatrixXd correlation = scale.asDiagonal() * matrix * scale.asDiagonal();
  if (!((correlation - correlation.transpose()).cwiseAbs().maxCoeff() <= kRounding)) {
    throw fault(map, key, "is not symmetric, expected a covariance");
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlation, Eigen::EigenvaluesOnly);
  if (!(solver.eigenvalues().minCoeff() >= -kRounding)) {
    throw fault(map, key, "has a negative eigenvalue, expected a covariance");
  }
  return matrix;
}

LensModel readModel(const YamlMap& map) {
  const std::string model = map.text("model");
  if (model == "pinhole") return LensModel::pinhole;
  if (model == "brown_conrady") return LensModel::brown_conrady;
  if (model == "kannala_brandt") return LensModel::kannala_brandt;
  throw fault(map, "model",
              "found " + inQuotes(model) + ", expected pinhole, brown_conrady or kannala_brandt");
}

void readFocalAndCentre(const YamlMap& map, Intrinsics& intrinsics) {
  constexpr std::array<std::pair<std::string_view, CameraParameter>, 4> kKeys{
      {{"fx", kFx}, {"fy", kFy}, {"cx", kCx}, {"cy", kCy}}};
  if (!map.has("K_matlab")) {
    for (const auto& [key, parameter] : kKeys) intrinsics.parameters[parameter] = map.number(key);
    return;
  }
  for (const auto& [key, parameter] : kKeys) {
    if (map.has(key)) throw fault(map, key, "is given beside K_matlab, expected one or the other");
  }
  const std::vector<double> k = map.numbers("K_matlab", 9);
  const bool transposed = k[1] == 0.0 && k[2] == 0.0 && k[3] == 0.0 && k[5] == 0.0 && k[8] == 1.0;
  if (!transposed) throw fault(map, "K_matlab", "is not of the form [fx 0 0; 0 fy 0; cx cy 1]");
  intrinsics.parameters = {k[0], k[4], k[6], k[7]};
}

void readDistortion(const YamlMap& map, Intrinsics& intrinsics) {
  if (!map.has("distortion")) return;
  const std::vector<double> distortion = map.numbers("distortion");
  const bool none = std::all_of(distortion.begin(), distortion.end(), [](double d) { return d == 0.0; });
  if (intrinsics.model == LensModel::pinhole && none) return;
  if (distortion.size() > kCameraParameters - kDistortion) {
    throw fault(map, "distortion",
                "has " + std::to_string(distortion.size()) + " coefficients, expected at most 8");
  }
  std::copy(distortion.begin(), distortion.end(), intrinsics.parameters.begin() + kDistortion);
  intrinsics.distortion_count = static_cast<int>(distortion.size());
}

Camera readCamera(const YamlMap& map) {
  constexpr int kLargestEdge = 1 << 16;
  map.allow({"width", "height", "model", "fx", "fy", "cx", "cy", "K_matlab", "distortion",
             "celsius_per_count", "celsius_offset", "T_body_camera", "netd", "bias_sigma", "blur",
             "covariance_intrinsics", "covariance_body_camera"});
  Intrinsics intrinsics;
  intrinsics.width_px = map.integer("width");
  intrinsics.height_px = map.integer("height");
  if (std::max(intrinsics.width_px, intrinsics.height_px) > kLargestEdge) {
    throw fault(map, "width", "the image is larger than " + std::to_string(kLargestEdge) + " pixels");
  }
  intrinsics.model = readModel(map);
  readFocalAndCentre(map, intrinsics);
  readDistortion(map, intrinsics);
  try {
    return Camera(intrinsics);
  } catch (const ConfigError& error) {
    throw fault(map, "", error.what());
  }
}

Eigen::MatrixXd readIntrinsicsCovariance(const YamlMap& map, const Camera& camera) {
  if (!map.has("covariance_intrinsics")) return {};
  return readCovariance(map, "covariance_intrinsics", kDistortion + camera.intrinsics().distortion_count);
}

/// Both numbers or none: one without the other says nothing.
std::optional<TLinear> readScale(const YamlMap& map) {
  if (!map.has("celsius_per_count") && !map.has("celsius_offset")) return std::nullopt;
  const TLinear t_linear{map.number("celsius_per_count"), map.number("celsius_offset")};
  if (!(t_linear.celsius_per_count > 0.0)) {
    throw fault(map, "celsius_per_count",
                "is " + exactText(t_linear.celsius_per_count) + ", expected more than 0");
  }
  return t_linear;
}

ThermalCamera readThermalCamera(const YamlMap& map) {
  ThermalCamera thermal{.camera = readCamera(map), .T_body_camera = readPose(map, "T_body_camera")};
  thermal.t_linear = readScale(map);
  thermal.netd = notNegative(map, "netd", thermal.netd);
  thermal.bias_sigma = notNegative(map, "bias_sigma", thermal.bias_sigma);
  thermal.blur_px = notNegative(map, "blur", thermal.blur_px);
  thermal.knows_blur = map.has("blur");
  thermal.covariance_intrinsics = readIntrinsicsCovariance(map, thermal.camera);
  if (map.has("covariance_body_camera")) {
    throw fault(map, "covariance_body_camera",
                "the thermal camera's pose is exact by definition, expected the "
                "covariance at the laser or the visible camera");
  }
  return thermal;
}

MountedCamera readVisibleCamera(const YamlMap& map) {
  MountedCamera visible{.camera = readCamera(map), .T_body_camera = readPose(map, "T_body_camera")};
  visible.covariance_intrinsics = readIntrinsicsCovariance(map, visible.camera);
  if (map.has("covariance_body_camera")) {
    visible.covariance_body_camera = readCovariance(map, "covariance_body_camera", 6);
  }
  return visible;
}

LaserKind readKind(const YamlMap& map) {
  const std::string kind = map.text("kind");
  if (kind == "beam") return LaserKind::beam;
  if (kind == "scan") return LaserKind::scan;
  if (kind == "cloud") return LaserKind::cloud;
  throw fault(map, "kind", "found " + inQuotes(kind) + ", expected beam, scan or cloud");
}

void readAngles(const YamlMap& map, Laser& laser) {
  constexpr double kLongestIncrement = 1.0;  // seconds; a sweep takes milliseconds
  laser.angle_min = map.number("angle_min");
  laser.angle_increment = map.number("angle_increment");
  const double increment = map.numberIf("time_increment").value_or(0.0);
  if (std::abs(increment) > kLongestIncrement) {
    throw fault(map, "time_increment",
                "is " + exactText(increment) + " s, expected at most 1 s from range to range");
  }
  laser.time_increment = durationFromSeconds(increment);
}

Laser readLaser(const YamlMap& map) {
  map.allow({"kind", "angle_min", "angle_increment", "time_increment", "range_min", "range_max",
             "range_sigma", "range_bias_sigma", "min_intensity", "T_body_laser", "covariance_body_laser"});
  Laser laser{.kind = readKind(map), .T_body_laser = readPose(map, "T_body_laser")};
  laser.range_min = map.number("range_min");
  laser.range_max = map.number("range_max");
  if (!(laser.range_min >= 0.0 && laser.range_max > laser.range_min)) {
    throw fault(map, "range_max",
                "the ranges go from " + exactText(laser.range_min) + " to " + exactText(laser.range_max) +
                    " m, expected 0 <= range_min < range_max");
  }
  laser.range_sigma = notNegative(map, "range_sigma", std::nullopt);
  laser.range_bias_sigma = notNegative(map, "range_bias_sigma", 0.0);
  laser.min_intensity = map.numberIf("min_intensity").value_or(laser.min_intensity);
  if (laser.kind == LaserKind::scan) readAngles(map, laser);
  if (map.has("covariance_body_laser"))
    laser.covariance_body_laser = readCovariance(map, "covariance_body_laser", 6);
  return laser;
}

}  // namespace

Rig parseRig(const std::string& text, const std::string& name) {
  const YamlMap map = YamlMap::parse(text, name);
  map.allow({"thermal_camera", "visible_camera", "laser"});
  Rig rig;
  if (const auto thermal = map.mapIf("thermal_camera")) rig.thermal_camera = readThermalCamera(*thermal);
  if (const auto visible = map.mapIf("visible_camera")) rig.visible_camera = readVisibleCamera(*visible);
  for (const YamlMap& laser : map.mapOrList("laser")) rig.lasers.push_back(readLaser(laser));
  return rig;
}

Rig readRig(const std::filesystem::path& file) {
  return parseRig(readWhole(file, "", kLargestRigFile), file.string());
}

}  // namespace thermovox
