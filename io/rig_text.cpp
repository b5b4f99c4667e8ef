#include <array>
#include <cmath>
#include <span>
#include <string_view>

#include "io/atomic_file.hpp"
#include "io/number_text.hpp"
#include "io/rig_file.hpp"
#include "projection/kind_names.hpp"

namespace thermovox {
namespace {

/// Lines of YAML at one depth.
class Block {
 public:
  Block(std::string& text, std::string_view indent) : text_(text), indent_(indent) {}

  void line(std::string_view key, std::string_view value) {
    text_.append(indent_).append(key).append(": ").append(value) += '\n';
  }
  void number(std::string_view key, double value) { line(key, exactText(value)); }
  void numbers(std::string_view key, std::span<const double> values) { line(key, list(values)); }

  void pose(std::string_view key, const Pose& pose) {
    line(key, "{translation: " + list({pose.translation.data(), 3}) +
                  ", quaternion_xyzw: " + list({pose.rotation.coeffs().data(), 4}) + "}");
  }
  /// Left out when it is empty or all zero: the rig does not say.
  void covariance(std::string_view key, const Eigen::MatrixXd& matrix) {
    if (matrix.size() == 0 || matrix.isZero(0.0)) return;
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = matrix;
    numbers(key, {rows.data(), static_cast<std::size_t>(rows.size())});
  }

 private:
  static std::string list(std::span<const double> values) {
    std::string text = "[";
    for (const double value : values) text += (text.size() > 1 ? ", " : "") + exactText(value);
    return text + "]";
  }

  std::string& text_;
  std::string indent_;
};

void writeIntrinsics(Block& block, const Intrinsics& in) {
  block.line("width", std::to_string(in.width_px));
  block.line("height", std::to_string(in.height_px));
  block.line("model", nameOf(in.model));
  constexpr std::array<std::string_view, 4> kKeys{"fx", "fy", "cx", "cy"};
  for (std::size_t i = 0; i < kKeys.size(); ++i) block.number(kKeys[i], in.parameters[i]);
  if (in.distortion_count > 0) {
    block.numbers("distortion",
                  {in.parameters.data() + kDistortion, static_cast<std::size_t>(in.distortion_count)});
  }
}

void writeThermalCamera(std::string& text, const ThermalCamera& thermal) {
  text += "thermal_camera:\n";
  Block block(text, "  ");
  writeIntrinsics(block, thermal.camera.intrinsics());
  if (const auto& t_linear = thermal.t_linear) {
    block.number("celsius_per_count", t_linear->celsius_per_count);
    block.number("celsius_offset", t_linear->celsius_offset);
  }
  block.pose("T_body_camera", thermal.T_body_camera);
  block.number("netd", thermal.netd);
  block.number("bias_sigma", thermal.bias_sigma);
  if (thermal.knows_blur) block.number("blur", thermal.blur_px);
  block.covariance("covariance_intrinsics", thermal.covariance_intrinsics);
}

void writeVisibleCamera(std::string& text, const MountedCamera& visible) {
  text += "visible_camera:\n";
  Block block(text, "  ");
  writeIntrinsics(block, visible.camera.intrinsics());
  block.pose("T_body_camera", visible.T_body_camera);
  block.covariance("covariance_intrinsics", visible.covariance_intrinsics);
  block.covariance("covariance_body_camera", visible.covariance_body_camera);
}

void writeLaser(std::string& text, const Laser& laser, std::string_view first, std::string_view indent) {
  text.append(first).append("kind: ").append(nameOf(laser.kind)) += '\n';
  Block block(text, indent);
  if (laser.kind == LaserKind::scan) {
    block.number("angle_min", laser.angle_min);
    block.number("angle_increment", laser.angle_increment);
    block.number("time_increment", toSeconds(laser.time_increment));
  }
  block.number("range_min", laser.range_min);
  block.number("range_max", laser.range_max);
  block.number("range_sigma", laser.range_sigma);
  block.number("range_bias_sigma", laser.range_bias_sigma);
  if (std::isfinite(laser.min_intensity)) block.number("min_intensity", laser.min_intensity);
  block.pose("T_body_laser", laser.T_body_laser);
  block.covariance("covariance_body_laser", laser.covariance_body_laser);
}

}  // namespace

std::string rigText(const Rig& rig) {
  std::string text;
  if (rig.thermal_camera) writeThermalCamera(text, *rig.thermal_camera);
  if (rig.visible_camera) writeVisibleCamera(text, *rig.visible_camera);
  if (!rig.lasers.empty()) text += "laser:\n";
  for (const Laser& laser : rig.lasers) {
    if (rig.lasers.size() == 1) {
      writeLaser(text, laser, "  ", "  ");
    } else {
      writeLaser(text, laser, "  - ", "    ");
    }
  }
  return text.empty() ? "{}\n" : text;
}

void writeRig(const std::filesystem::path& file, const Rig& rig) {
  AtomicFile output(file, Existing::replace);
  output.write(rigText(rig));
  output.commit();
}

}  // namespace thermovox
