#pragma once

#include <gmock/gmock.h>

#include <Eigen/Core>

namespace thermovox::test {

/// Two matrices or vectors of one shape differ by at most `tolerance` in the Euclidean (Frobenius) norm. NaN
/// never matches.
MATCHER_P2(IsNear, expected, tolerance, "") {
  const double distance = (arg - expected).norm();
  *result_listener << "which is " << distance << " off";
  return distance <= tolerance;
}

}  // namespace thermovox::test
