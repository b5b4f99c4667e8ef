#include "apps/simulate/board_render.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/simulate/parallel.hpp"

namespace thermovox::simulate {
namespace {

constexpr int kSamples = 8;  // a mixed cell and axis
constexpr float kNoPlace = std::numeric_limits<float>::quiet_NaN();

/// The part of the blur that a pixel's own square does not make: that has the variance 1 / 12 px^2.
std::vector<float> opticsKernel(double blur_px, int cells_per_pixel) {
  const double variance_px = blur_px * blur_px - 1.0 / 12.0;
  if (variance_px <= 0.0) return {1.0F};
  const double sigma = cells_per_pixel * std::sqrt(variance_px);
  const int reach = std::max(static_cast<int>(std::ceil(4.0 * sigma)), 1);
  std::vector<float> kernel;
  float sum = 0.0F;
  for (int i = -reach; i <= reach; ++i) {
    kernel.push_back(static_cast<float>(std::exp(-0.5 * i * i / (sigma * sigma))));
    sum += kernel.back();
  }
  for (float& weight : kernel) weight /= sum;
  return kernel;
}

/// A rectangle of the board's plane: a square of the pattern, a piece of the margin (column -1, say) or of
/// what is beyond the plate (-2). Such a rectangle is convex, so a cell with all corners in it is in it.
struct Region {
  int column = 0;
  int row = 0;
  friend bool operator==(const Region&, const Region&) = default;
};

/// The board as regions of its plane.
class Regions {
 public:
  explicit Regions(const CalibrationBoard& board)
      : square_(static_cast<float>(board.square)),
        columns_(board.columns + 1),
        rows_(board.rows + 1),
        half_width_(static_cast<float>(0.5 * board.width)),
        half_height_(static_cast<float>(0.5 * board.height)) {}

  [[nodiscard]] Region at(const Eigen::Vector2f& place) const {
    return {along(place.x(), half_width_, columns_), along(place.y(), half_height_, rows_)};
  }
  [[nodiscard]] BoardPart part(const Region& region) const {
    const auto beyond = [](int index, int squares) { return index < -1 || index > squares; };
    const auto plain = [](int index, int squares) { return index < 0 || index >= squares; };
    if (beyond(region.column, columns_) || beyond(region.row, rows_)) return BoardPart::surroundings;
    if (plain(region.column, columns_) || plain(region.row, rows_)) return BoardPart::margin;
    return (region.column + region.row) % 2 == 0 ? BoardPart::dark_square : BoardPart::light_square;
  }

 private:
  /// 0 .. squares - 1 for squares, one more either way for the margin, two for beyond; NaN is beyond.
  [[nodiscard]] int along(float coordinate, float half_plate, int squares) const {
    if (!(coordinate >= -half_plate)) return -2;
    if (coordinate >= half_plate) return squares + 1;
    const float squares_from_middle = coordinate / square_;
    return std::clamp(static_cast<int>(std::floor(squares_from_middle + 0.5F * static_cast<float>(squares))),
                      -1, squares);
  }

  float square_;
  int columns_;  ///< of squares
  int rows_;
  float half_width_;
  float half_height_;
};

/// Where the corners of a cell are on the board's plane: top left, top right, bottom left, bottom right.
using Quad = std::array<Eigen::Vector2f, 4>;

float meanOf(const Quad& quad, const Regions& regions, const BoardPaint& paint) {
  const Region region = regions.at(quad[0]);
  const bool whole = std::all_of(quad.begin() + 1, quad.end(),
                                 [&](const Eigen::Vector2f& place) { return regions.at(place) == region; });
  if (whole) return paint(regions.part(region), 0.25F * (quad[0] + quad[1] + quad[2] + quad[3]));
  float sum = 0.0F;
  for (int i = 0; i < kSamples * kSamples; ++i) {
    const int column = i % kSamples, row = i / kSamples;
    const float x = (static_cast<float>(column) + 0.5F) / kSamples;
    const float y = (static_cast<float>(row) + 0.5F) / kSamples;
    const Eigen::Vector2f upper = quad[0] + x * (quad[1] - quad[0]);
    const Eigen::Vector2f lower = quad[2] + x * (quad[3] - quad[2]);
    const Eigen::Vector2f place = upper + y * (lower - upper);
    sum += paint(regions.part(regions.at(place)), place);
  }
  return sum / (kSamples * kSamples);
}

/// Maps a ray (x, y, 1) of the camera to the plane z = 0 of the board, as homogeneous coordinates whose last
/// one is positive where the ray meets the plane before the camera.
Eigen::Matrix3f planeFromRay(const Pose& T_camera_board) {
  const Pose T_board_camera = T_camera_board.inverse();
  const Eigen::Matrix3d R = T_board_camera.matrix();
  const Eigen::Vector3d& o = T_board_camera.translation;
  // p = o + s R ray with s = -o.z / (R ray).z: p.xy (R ray).z = o.xy (R ray).z - o.z (R ray).xy.
  Eigen::Matrix3d H;
  H.row(0) = o.x() * R.row(2) - o.z() * R.row(0);
  H.row(1) = o.y() * R.row(2) - o.z() * R.row(1);
  H.row(2) = R.row(2);
  return (o.z() < 0.0 ? H : Eigen::Matrix3d(-H)).cast<float>();
}

}  // namespace

BoardRenderer::BoardRenderer(const Camera& camera, int cells_per_pixel, double blur_px, unsigned threads)
    : cells_per_pixel_(cells_per_pixel),
      columns_(camera.width() * cells_per_pixel),
      rows_(camera.height() * cells_per_pixel),
      kernel_(opticsKernel(blur_px, cells_per_pixel)) {
  const auto width = static_cast<std::size_t>(columns_) + 1;
  rays_.resize(width * (static_cast<std::size_t>(rows_) + 1), Eigen::Vector2f(kNoPlace, kNoPlace));
  const auto pixelOf = [&](std::size_t cell) { return static_cast<double>(cell) / cells_per_pixel - 0.5; };
  forEachIndex(rays_.size() / width, threads, [&](std::size_t row) {
    for (std::size_t column = 0; column < width; ++column) {
      const auto ray = camera.rayFromPixel({pixelOf(column), pixelOf(row)});
      if (ray) rays_[row * width + column] = ray->head<2>().cast<float>();
    }
  });
}

BoardRenderer::Places BoardRenderer::placesOf(int row, const Eigen::Matrix3f& plane_from_ray) const {
  Places places;
  const auto width = static_cast<std::size_t>(columns_) + 1;
  places.reserve(width);
  for (std::size_t i = static_cast<std::size_t>(row) * width; places.size() < width; ++i) {
    const Eigen::Vector3f meets = plane_from_ray * rays_[i].homogeneous();
    places.push_back(meets.z() > 0.0F ? Eigen::Vector2f(meets.hnormalized())
                                      : Eigen::Vector2f(kNoPlace, kNoPlace));
  }
  return places;
}

std::vector<float> BoardRenderer::blurred(const std::vector<float>& cells) const {
  const auto reach = static_cast<int>(kernel_.size() / 2);
  std::vector<float> across(cells.size()), result(cells.size());
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      float sum = 0.0F;
      for (int i = 0; i <= 2 * reach; ++i) {
        const int from = std::clamp(column + i - reach, 0, columns_ - 1);
        sum += kernel_[static_cast<std::size_t>(i)] * cells[at(row, from)];
      }
      across[at(row, column)] = sum;
    }
  }
  for (int row = 0; row < rows_; ++row) {
    for (int i = 0; i <= 2 * reach; ++i) {
      const float weight = kernel_[static_cast<std::size_t>(i)];
      const float* from = across.data() + at(std::clamp(row + i - reach, 0, rows_ - 1), 0);
      float* to = result.data() + at(row, 0);
      for (int column = 0; column < columns_; ++column) to[column] += weight * from[column];
    }
  }
  return result;
}

std::vector<float> BoardRenderer::pixelsOf(const std::vector<float>& cells) const {
  if (cells_per_pixel_ == 1) return cells;
  std::vector<float> pixels;
  for (int top = 0; top < rows_; top += cells_per_pixel_) {
    for (int left = 0; left < columns_; left += cells_per_pixel_) {
      float sum = 0.0F;
      for (int row = top; row < top + cells_per_pixel_; ++row)
        for (int column = left; column < left + cells_per_pixel_; ++column) sum += cells[at(row, column)];
      pixels.push_back(sum / static_cast<float>(cells_per_pixel_ * cells_per_pixel_));
    }
  }
  return pixels;
}

std::vector<float> BoardRenderer::render(const CalibrationBoard& board, const Pose& T_camera_board,
                                         const BoardPaint& paint) const {
  const Eigen::Matrix3f plane_from_ray = planeFromRay(T_camera_board);
  const Regions regions(board);
  std::vector<float> cells;
  cells.reserve(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  Places upper = placesOf(0, plane_from_ray);
  for (int row = 0; row < rows_; ++row) {
    Places lower = placesOf(row + 1, plane_from_ray);
    for (std::size_t i = 0; i + 1 < upper.size(); ++i)
      cells.push_back(meanOf({upper[i], upper[i + 1], lower[i], lower[i + 1]}, regions, paint));
    upper = std::move(lower);
  }
  return pixelsOf(blurred(cells));
}

}  // namespace thermovox::simulate
