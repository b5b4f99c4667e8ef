#include "calibration/circle_refinement.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace thermovox {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kCell = 0.9;        // of what is nearer to a circle than to its neighbours: |x| + |y| < 1
constexpr double kBeyond = 0.3;      // of the board around the circle: further out the plate may end
constexpr double kMostMoved = 0.35;  // radii from the guess
constexpr double kStandsOut = 3.0;   // sigmas
constexpr double kStill = 1e-4;      // px, of the last step
constexpr int kSteps = 20;
constexpr std::size_t kFewest = 14;  // pixels for six unknowns

/// A pixel of the image about a circle, before the circle is moved.
struct CellPixel {
  Eigen::Vector2d x;  ///< from the guess, px
  double value;
};

/// The outline of a circle as the homography has it, by pixels from its middle.
class Outline {
 public:
  explicit Outline(const CircleGuess& guess)
      : board_from_pixel_(guess.pixel_from_board.inverse()),
        middle_(guess.middle),
        radius_(guess.radius),
        pixel_((guess.pixel_from_board * guess.middle.homogeneous()).hnormalized()) {}

  /// From the circle's middle, on the board.
  [[nodiscard]] Eigen::Vector2d onBoard(const Eigen::Vector2d& from_middle) const {
    return (board_from_pixel_ * (pixel_ + from_middle).homogeneous()).hnormalized() - middle_;
  }
  struct Place {
    double inside;           ///< px to the outline; less than 0 outside of it
    Eigen::Vector2d normal;  ///< outwards, px
  };
  /// To first order in the distance, which is what counts where the edge is.
  [[nodiscard]] Place at(const Eigen::Vector2d& from_middle) const {
    const Eigen::Vector3d b = board_from_pixel_ * (pixel_ + from_middle).homogeneous();
    const Eigen::Vector2d board = b.hnormalized();
    const Eigen::Matrix2d by_pixel =
        (board_from_pixel_.topLeftCorner<2, 2>() - board * board_from_pixel_.bottomLeftCorner<1, 2>()) /
        b.z();
    const Eigen::Vector2d arm = board - middle_;
    const Eigen::Vector2d gradient = by_pixel.transpose() * (arm / std::max(arm.norm(), 1e-12));
    const double slope = std::max(gradient.norm(), 1e-12);
    return {(radius_ - arm.norm()) / slope, gradient / slope};
  }

 private:
  Eigen::Matrix3d board_from_pixel_;
  Eigen::Vector2d middle_;
  double radius_;
  Eigen::Vector2d pixel_;
};

/// Empty where the circle leaves the image.
std::vector<CellPixel> cellOf(const BoardImage& image, const CircleGuess& guess, const Outline& outline) {
  const Eigen::Vector2d last(image.width - 1, image.height - 1);
  if (!(guess.pixel.minCoeff() >= 0.0 && (last - guess.pixel).minCoeff() >= 0.0)) return {};
  // The cell is within the box about its corners, which lie one unit away.
  Eigen::Vector2d low = guess.pixel, high = guess.pixel;
  for (const Eigen::Vector2d& arm : {Eigen::Vector2d(1.0, 0.0), {-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}}) {
    const Eigen::Vector2d way = (guess.pixel_from_board * (guess.middle + arm).homogeneous()).hnormalized() -
                                (guess.pixel_from_board * guess.middle.homogeneous()).hnormalized();
    low = low.cwiseMin(guess.pixel + way);
    high = high.cwiseMax(guess.pixel + way);
  }
  if (!((high - low).maxCoeff() < image.width + image.height)) return {};
  std::vector<CellPixel> cell;
  for (int v = static_cast<int>(std::ceil(low.y())); v <= high.y(); ++v) {
    for (int u = static_cast<int>(std::ceil(low.x())); u <= high.x(); ++u) {
      const Eigen::Vector2d x = Eigen::Vector2d(u, v) - guess.pixel;
      const Eigen::Vector2d board = outline.onBoard(x);
      if (!(board.lpNorm<1>() <= kCell && board.norm() <= guess.radius + kBeyond)) continue;
      if (u < 0 || v < 0 || u >= image.width || v >= image.height) return {};
      cell.push_back({x, image.at(u, v)});
    }
  }
  return cell;
}

/// Unknowns: p - guess, c, g, A. The model is linear in the last four, so that a step needs no start for
/// them.
struct Normals {
  Matrix6 information = Matrix6::Zero();
  Vector6d right = Vector6d::Zero();
  double squares = 0.0;  ///< of the residuals
};

Normals normalsOf(const std::vector<CellPixel>& cell, const Outline& outline, const Vector6d& unknowns,
                  double blur) {
  Normals normals;
  for (const CellPixel& pixel : cell) {
    const Eigen::Vector2d from_middle = pixel.x - unknowns.head<2>();
    const Outline::Place place = outline.at(from_middle);
    const double t = place.inside / blur;
    const double share = 0.5 * (1.0 + std::erf(t / std::numbers::sqrt2));
    const double slope = std::exp(-0.5 * t * t) / (std::sqrt(2.0 * std::numbers::pi) * blur);
    Vector6d derivative;
    derivative << unknowns[5] * slope * place.normal - unknowns.segment<2>(3), 1.0, from_middle, share;
    const double residual =
        pixel.value - unknowns[2] - unknowns.segment<2>(3).dot(from_middle) - unknowns[5] * share;
    normals.information += derivative * derivative.transpose();
    normals.right += derivative * residual;
    normals.squares += residual * residual;
  }
  return normals;
}

/// The level and the disc's height for a circle that stays where it is.
Vector6d startOf(const std::vector<CellPixel>& cell, const Outline& outline, double blur) {
  const Normals normals = normalsOf(cell, outline, Vector6d::Zero(), blur);
  Vector6d unknowns = Vector6d::Zero();
  unknowns.tail<4>() = normals.information.bottomRightCorner<4, 4>().ldlt().solve(normals.right.tail<4>());
  return unknowns;
}

/// The fit to the cell as it lies about the guess.
std::optional<BoardCorner> fitted(const BoardImage& image, const CircleGuess& guess, double blur_px) {
  const Outline outline(guess);
  const std::vector<CellPixel> cell = cellOf(image, guess, outline);
  if (cell.size() < kFewest) return std::nullopt;
  const double radius_px = outline.at(Eigen::Vector2d(1e-3, 0.0)).inside;
  Vector6d unknowns = startOf(cell, outline, blur_px);
  bool still = false;
  for (int step = 0; step < kSteps && !still; ++step) {
    const Normals normals = normalsOf(cell, outline, unknowns, blur_px);
    const Vector6d change = normals.information.ldlt().solve(normals.right);
    unknowns += change;
    if (!unknowns.allFinite() || unknowns.head<2>().norm() > kMostMoved * radius_px) return std::nullopt;
    still = change.head<2>().norm() < kStill;
  }
  const Normals normals = normalsOf(cell, outline, unknowns, blur_px);
  const double variance = normals.squares / static_cast<double>(cell.size() - 6);
  const Matrix6 covariance = variance * normals.information.ldlt().solve(Matrix6::Identity());
  BoardCorner corner{guess.pixel + unknowns.head<2>(), covariance.topLeftCorner<2, 2>(), 0.0};
  corner.contrast_sigma = 0.5 * std::abs(unknowns[5]) / std::sqrt(std::max(variance, 1e-300));
  if (!still || !corner.covariance.allFinite() || corner.contrast_sigma < kStandsOut) return std::nullopt;
  return corner;
}

}  // namespace

std::optional<BoardCorner> refineCircle(const BoardImage& image, const CircleGuess& guess, double blur_px) {
  if (!guess.pixel_from_board.allFinite() || !guess.middle.allFinite() || !guess.pixel.allFinite() ||
      !(guess.radius > 0.0) || !(std::abs(guess.pixel_from_board.determinant()) > 0.0)) {
    return std::nullopt;
  }
  const std::optional<BoardCorner> first = fitted(image, guess, blur_px);
  if (!first) return std::nullopt;
  CircleGuess nearer = guess;  // the cell reaches to the same distance on all sides
  nearer.pixel = first->pixel;
  return fitted(image, nearer, blur_px);
}

}  // namespace thermovox
