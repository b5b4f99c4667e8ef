// The paper's own method, a whole blob at one beam's depth, and what it claims of it.
#include "mapping/blob_location.hpp"

#include <gmock/gmock.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <random>

#include "projection/error.hpp"

namespace thermovox {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

/// A camera like the paper's Duo R: 160 x 120 pixels over 57 by 44 degrees. K is our own choice.
ThermalCamera duoR() {
  Intrinsics in{.width_px = 160, .height_px = 120};
  in.parameters = {147.3, 148.5, 79.5, 59.5};
  return {.camera = Camera(in), .netd = 0.05, .bias_sigma = 5.0};
}

/// Laser x to the camera's z: the body is the camera's frame.
const Eigen::Quaterniond kForward((Eigen::Matrix3d() << 0, -1, 0, 0, 0, -1, 1, 0, 0).finished());

BeamShot shotAt(double range, const Eigen::Vector3d& t_body_laser = Eigen::Vector3d::Zero()) {
  return {.beam = {.T_body_laser = {kForward, t_body_laser}, .range_sigma = 0.008},
          .camera = duoR(),
          .range = range};
}

ThermalImage plainImage(float celsius = 20.0F) {
  return {160, 120, std::vector<float>(160 * 120, celsius), nullptr, {}};
}

float& at(ThermalImage& image, int u, int v) {
  return image.celsius[static_cast<std::size_t>(v * image.width + u)];
}

/// What the camera sees of a plane (body frame) at 20 C with one spot on it, blurred by 0.7 px.
ThermalImage viewOf(const BeamShot& shot, const Eigen::Vector3d& spot, double rise, double width) {
  ThermalImage image = plainImage();
  const Eigen::Vector3d n = shot.planeNormalBody(), h = shot.hitBody();
  const Eigen::Vector3d spot_camera = shot.camera.T_body_camera.inverse() * spot;
  const Eigen::Vector2d middle = shot.camera.camera.project(spot_camera).value();
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      if ((Eigen::Vector2d(u, v) - middle).norm() > 45.0) continue;  // five widths at the nearest
      const Eigen::Vector3d o = shot.camera.T_body_camera.translation;
      const Eigen::Vector3d d =
          shot.camera.T_body_camera.rotation * shot.camera.camera.rayFromPixel({u, v}).value();
      const double depth = n.dot(h - o) / n.dot(d);
      const double blur2 = std::pow(0.7 * depth / 148.0, 2), w2 = width * width;
      const double r2 = (o + depth * d - spot).squaredNorm();
      at(image, u, v) += static_cast<float>(rise * w2 / (w2 + blur2) * std::exp(-0.5 * r2 / (w2 + blur2)));
    }
  }
  return image;
}

void addNoise(ThermalImage& image, double sigma, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0.0, sigma);
  for (float& celsius : image.celsius) celsius += static_cast<float>(normal(random));
}

TEST(LocateBlobs, AlongTheOpticalAxisIsThePapersEquation1) {
  // The paper's figure 4: 710 mm, with this K the pixel (66.18284, 82.31044). Four pixels have it as
  // centroid.
  ThermalImage image = plainImage();
  const double fu = 0.18284, fv = 0.31044;
  at(image, 66, 82) = static_cast<float>(40.0 + 100.0 * (1 - fu) * (1 - fv));
  at(image, 67, 82) = static_cast<float>(40.0 + 100.0 * fu * (1 - fv));
  at(image, 66, 83) = static_cast<float>(40.0 + 100.0 * (1 - fu) * fv);
  at(image, 67, 83) = static_cast<float>(40.0 + 100.0 * fu * fv);
  const std::vector<ThermalBlob> blobs = locateBlobs(image, 40.0, shotAt(0.710));
  ASSERT_THAT(blobs, SizeIs(1));
  EXPECT_NEAR(blobs[0].pixel.x(), 66.18284, 1e-5);
  EXPECT_NEAR(blobs[0].pixel.y(), 82.31044, 1e-5);
  ASSERT_TRUE(blobs[0].place);
  const Eigen::Vector3d p_mm = 1e3 * blobs[0].place->p_camera;
  EXPECT_NEAR(p_mm.x(), -64.19, 0.005);  // half of the last decimal that the paper gives
  EXPECT_NEAR(p_mm.y(), 109.06, 0.005);
  EXPECT_NEAR(p_mm.z(), 710.00, 0.005);
}

TEST(LocateBlobs, LieOnThePlaneAndOnTheRaysOfTheirCentroids) {
  BeamShot shot = shotAt(3.0, {0.1, -0.2, 0.05});
  shot.camera.T_body_camera = {expRotation({0.05, -0.1, 0.02}), {-0.03, 0.04, 0.0}};
  for (const bool slanted : {false, true}) {
    if (slanted) shot.normal_body = Eigen::Vector3d(0.5, -0.3, 0.8).normalized();
    const Eigen::Vector3d n = shot.planeNormalBody();
    const Eigen::Vector3d along = n.unitOrthogonal();
    const Eigen::Vector3d spot = shot.hitBody() + 0.3 * along + 0.2 * n.cross(along);
    const auto blobs = locateBlobs(viewOf(shot, spot, 60.0, 0.08), 35.0, shot);
    ASSERT_THAT(blobs, SizeIs(1));
    ASSERT_TRUE(blobs[0].place);
    const BlobPlace& place = *blobs[0].place;
    EXPECT_NEAR(n.dot(place.p_body - shot.hitBody()), 0.0, 1e-9);
    EXPECT_LT((*shot.camera.camera.project(place.p_camera) - blobs[0].pixel).norm(), 1e-6);
    EXPECT_LT((shot.camera.T_body_camera * place.p_camera - place.p_body).norm(), 1e-9);
    // A slanted spot's warm side is larger in the image, so its centroid is not its middle.
    EXPECT_LT((place.p_body - spot).norm(), slanted ? 0.01 : 0.003);
  }
}

/// The covariance against the spread of 2000 draws of the same errors: entries are good to 3 % of its size.
void expectSpread(BeamShot shot) {
  shot.beam.range_bias_sigma = 0.005;
  Vector6d sigmas;
  sigmas << 0.004, 0.003, 0.005, 0.004, 0.006, 0.005;
  shot.beam.covariance_body_laser = sigmas.cwiseAbs2().asDiagonal();
  shot.camera.netd = 2.0;
  const Eigen::Vector3d spot = shot.hitBody() + Eigen::Vector3d(0.25, 0.3, 0.0);
  const ThermalImage calm = viewOf(shot, spot, 60.0, 0.07);
  const std::vector<ThermalBlob> nominal = locateBlobs(calm, 35.0, shot);
  ASSERT_THAT(nominal, SizeIs(1));
  const BlobPlace& place = nominal[0].place.value();
  std::mt19937_64 random(21);
  std::normal_distribution<double> normal;
  constexpr int kDraws = 2000;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (int i = 0; i < kDraws; ++i) {
    BeamShot drawn = shot;
    const Vector6d off = sigmas.cwiseProduct(Vector6d(Vector6d::NullaryExpr([&] { return normal(random); })));
    drawn.beam.T_body_laser.rotation = expRotation(off.head<3>()) * shot.beam.T_body_laser.rotation;
    drawn.beam.T_body_laser.translation += off.tail<3>();
    drawn.range += 0.008 * normal(random) + 0.005 * normal(random);
    const std::vector<ThermalBlob> blobs = locateBlobs(calm, 35.0, drawn);
    const Eigen::Vector3d error = blobs.at(0).place.value().p_body - place.p_body;
    spread += error * error.transpose() / kDraws;
  }
  const Eigen::Matrix3d said = place.covariance();
  // The noise of the pixels is tested apart: here it is still.
  BeamShot still = shot;
  still.camera.netd = 0.0;
  BeamShot exact = still;
  exact.beam.range_sigma = exact.beam.range_bias_sigma = 0.0;
  exact.beam.covariance_body_laser.setZero();
  const Eigen::Matrix3d of_pixels = locateBlobs(calm, 35.0, exact)[0].place->covariance();
  const Eigen::Matrix3d of_beam = locateBlobs(calm, 35.0, still)[0].place->covariance() - of_pixels;
  EXPECT_LT((of_beam - spread).norm(), 0.08 * spread.norm()) << of_beam << "\nfound\n" << spread;
  EXPECT_GT(said.trace(), of_beam.trace());
}

TEST(LocateBlobs, SayWhatErrorsOfTheBeamScatterThemBy) {
  expectSpread(shotAt(2.0, {0.1, -0.2, 0.05}));
  BeamShot slanted = shotAt(2.0, {0.1, -0.2, 0.05});
  slanted.normal_body = Eigen::Vector3d(0.4, -0.3, 0.8).normalized();
  expectSpread(slanted);
}

TEST(LocateBlobs, SayWhatTheNoiseOfThePixelsScattersTheCentroidBy) {
  BeamShot shot = shotAt(2.0);
  shot.camera.netd = 1.0;
  const ThermalImage calm = viewOf(shot, {0.2, 0.1, 2.0}, 60.0, 0.07);
  const ThermalBlob nominal = locateBlobs(calm, 30.0, shot).at(0);
  std::mt19937_64 random(22);
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  constexpr int kDraws = 300;
  for (int i = 0; i < kDraws; ++i) {
    ThermalImage noisy = calm;
    addNoise(noisy, 1.0, random);
    const Eigen::Vector2d off = locateBlobs(noisy, 30.0, shot).at(0).pixel - nominal.pixel;
    spread += off * off.transpose() / kDraws;
  }
  // What is said holds the size of a pixel besides, which a smooth blob hardly feels.
  EXPECT_LT(spread.trace(), nominal.pixel_covariance.trace());
  EXPECT_GT(spread.trace(), 0.1 * nominal.pixel_covariance.trace());
}

TEST(LocateBlobs, AreTheHottestFirstAndTouchByTheirCorners) {
  ThermalImage image = plainImage();
  at(image, 10, 10) = 50.0F;
  at(image, 11, 11) = 51.0F;  // by a corner
  at(image, 13, 11) = 52.0F;  // apart
  at(image, 0, 119) = 80.0F;
  at(image, 159, 0) = std::nanf("");
  at(image, 158, 0) = 40.0F;  // the very temperature is hot
  const auto blobs = locateBlobs(image, 40.0, shotAt(2.0));
  ASSERT_THAT(blobs, SizeIs(4));
  EXPECT_EQ(blobs[0].pixel, Eigen::Vector2d(0, 119));
  EXPECT_EQ(blobs[1].peak.value, 52.0);
  EXPECT_EQ(blobs[2].pixels, 2U);
  EXPECT_EQ(blobs[2].mean, 50.5);
  EXPECT_EQ(blobs[3].pixel, Eigen::Vector2d(158, 0));
  for (const ThermalBlob& blob : blobs) {
    EXPECT_TRUE(blob.reads_low);
    EXPECT_EQ(blob.peak.sigma, 0.05);
    EXPECT_EQ(blob.bias_sigma, 5.0);
  }
}

TEST(LocateBlobs, ReadLowUnderThreeByThreePixels) {
  const auto readsLow = [](int width, int height) {
    ThermalImage image = plainImage();
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) at(image, 50 + u, 50 + v) = 60.0F;
    }
    return locateBlobs(image, 40.0, shotAt(2.0)).at(0).reads_low;
  };
  EXPECT_FALSE(readsLow(3, 3));
  EXPECT_TRUE(readsLow(2, 4));
  EXPECT_TRUE(readsLow(30, 2));
  EXPECT_FALSE(readsLow(3, 4));
}

TEST(LocateBlobs, CoverTheAreaThatTheirPixelsSee) {
  ThermalImage image = plainImage();
  for (int v = 40; v < 60; ++v) {
    for (int u = 30; u < 70; ++u) at(image, u, v) = 60.0F;
  }
  BeamShot shot = shotAt(3.0);
  const double across = 800.0 * 9.0 / (147.3 * 148.5);
  EXPECT_NEAR(locateBlobs(image, 40.0, shot)[0].place->area, across, 1e-6);
  // By its corners on a plane that leans: half a pixel further out than the outermost centres.
  shot.normal_body = Eigen::Vector3d(0.5, 0.0, 1.0).normalized();
  std::vector<Eigen::Vector3d> corners;
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(29.5, 39.5), Eigen::Vector2d(69.5, 39.5),
                                       Eigen::Vector2d(69.5, 59.5), Eigen::Vector2d(29.5, 59.5)}) {
    const Eigen::Vector3d d = shot.camera.camera.rayFromPixel(pixel).value();
    corners.push_back(d * shot.normal_body->dot(shot.hitBody()) / shot.normal_body->dot(d));
  }
  const double area = 0.5 * ((corners[1] - corners[0]).cross(corners[2] - corners[0]).norm() +
                             (corners[2] - corners[0]).cross(corners[3] - corners[0]).norm());
  EXPECT_NEAR(locateBlobs(image, 40.0, shot)[0].place->area, area, 1e-3 * area);
}

TEST(LocateBlobs, AreNowhereWhereTheirRayMissesThePlane) {
  ThermalImage image = plainImage();
  at(image, 80, 60) = 60.0F;
  BeamShot shot = shotAt(2.0);
  shot.normal_body = Eigen::Vector3d::UnitX();  // edge on
  EXPECT_FALSE(locateBlobs(image, 40.0, shot).at(0).place);
  BeamShot backwards = shotAt(2.0);
  backwards.beam.T_body_laser.rotation = expRotation({M_PI, 0, 0}) * kForward;
  EXPECT_FALSE(locateBlobs(image, 40.0, backwards).at(0).place);
}

TEST(LocateBlobs, OfNothingHotAreNone) {
  EXPECT_THAT(locateBlobs(plainImage(), 40.0, shotAt(2.0)), IsEmpty());
  EXPECT_THAT(locateBlobs(plainImage(std::nanf("")), -300.0, shotAt(2.0)), IsEmpty());
  EXPECT_THAT(locateBlobs(plainImage(), 20.0, shotAt(2.0)), SizeIs(1));  // all of it
}

TEST(LocateBlobs, RefuseWhatDoesNotFit) {
  ThermalImage small{4, 3, std::vector<float>(12, 50.0F), nullptr, {}};
  EXPECT_THROW((void)locateBlobs(small, 40.0, shotAt(2.0)), DataError);
  BeamShot scan = shotAt(2.0);
  scan.beam.kind = LaserKind::scan;
  EXPECT_THROW((void)locateBlobs(plainImage(), 40.0, scan), ConfigError);
  BeamShot bent = shotAt(2.0);
  bent.normal_body = Eigen::Vector3d(1.0, 1.0, 0.0);
  EXPECT_THROW((void)locateBlobs(plainImage(), 40.0, bent), ConfigError);
  for (const double range : {0.0, -1.0, 1e9, std::nan("")}) {
    EXPECT_THROW((void)locateBlobs(plainImage(), 40.0, shotAt(range)), DataError) << range;
  }
}

/// The paper's set-up: its beam beside its camera, a surface across the beam at 0.86 m and 4.08 m, ranges
/// within 8 mm of the truth (what the paper's laser is good to), the camera's noise, and a joint anywhere
/// near the beam, so that it falls on the pixels in all ways. What the paper counts as the worst error of the
/// place is that along the beam.
TEST(PaperClaims, AHotSpotIsLocatedWithin8MillimetresAndItsTemperatureScattersLessThan1Point11Degrees) {
  std::mt19937_64 random(86);
  std::uniform_real_distribution<double> range_error(-0.008, 0.008), aside(-0.5, 0.5);
  for (const double distance : {0.86, 4.08}) {
    SCOPED_TRACE(distance);
    BeamShot shot = shotAt(distance, {0.02, -0.05, -0.01});
    const double pixel = distance / 148.0;
    double worst_along = 0.0, worst = 0.0, sum = 0.0, squares = 0.0;
    constexpr int kShots = 150;
    for (int i = 0; i < kShots; ++i) {
      shot.range = distance;
      const Eigen::Vector3d spot =
          shot.hitBody() + pixel * Eigen::Vector3d(aside(random), aside(random), 0.0);
      ThermalImage image = viewOf(shot, spot, 24.15, 0.05);
      addNoise(image, shot.camera.netd, random);
      shot.range += range_error(random);
      const auto blobs = locateBlobs(image, 32.0, shot);
      ASSERT_THAT(blobs, SizeIs(1));
      const Eigen::Vector3d error = blobs[0].place.value().p_body - spot;
      worst_along = std::max(worst_along, std::abs(error.z()));
      worst = std::max(worst, error.norm());
      sum += blobs[0].peak.value;
      squares += blobs[0].peak.value * blobs[0].peak.value;
    }
    const double mean = sum / kShots;
    const double deviation = std::sqrt(squares / kShots - mean * mean);
    EXPECT_LE(worst_along, 0.008 + 1e-9);
    EXPECT_LT(worst, 0.010);  // what the centroid adds across the beam
    EXPECT_LT(deviation, 1.11);
    EXPECT_NEAR(mean, 44.15, 6.0);  // one distance's blur and pixels take off what they do
  }
}

}  // namespace
}  // namespace thermovox
