#pragma once

#include "calibration/plane_residual.hpp"

namespace thermovox {

/// A bias that is about 0: [1]. Residual: 1.
struct PriorResidual {
  double sigma;
  template <typename T>
  bool operator()(const T* value, T* residual) const {
    *residual = *value / T(sigma);
    return true;
  }
};

/// The sum of a capture's bias and that of all ranges takes the place of the first in PlaneResidual.
struct PlaneResidualWithCommonBias {
  PlaneResidual residual_of;
  template <typename T>
  bool operator()(const T* T_reference_board, const T* T_reference_laser, const T* range_bias,
                  const T* common_bias, T* residual) const {
    const T bias = *range_bias + *common_bias;
    return residual_of(T_reference_board, T_reference_laser, &bias, residual);
  }
};

}  // namespace thermovox
