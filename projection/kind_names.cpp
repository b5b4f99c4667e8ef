#include "projection/kind_names.hpp"

namespace thermovox {

const char* nameOf(LaserKind kind) {
  switch (kind) {
    case LaserKind::beam:
      return "beam";
    case LaserKind::scan:
      return "scan";
    case LaserKind::cloud:
      break;
  }
  return "cloud";
}

const char* nameOf(LensModel model) {
  switch (model) {
    case LensModel::pinhole:
      return "pinhole";
    case LensModel::brown_conrady:
      return "brown_conrady";
    case LensModel::kannala_brandt:
      break;
  }
  return "kannala_brandt";
}

const char* nameOf(AtmosphereModel model) {
  return model == AtmosphereModel::half ? "half" : "single";
}

const char* nameOf(CalibrationBoard::Pattern pattern) {
  return pattern == CalibrationBoard::Pattern::chessboard ? "chessboard" : "asymmetric_circles";
}

}  // namespace thermovox
