#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "io/calibration_plots.hpp"
#include "io/calibration_sections.hpp"
#include "io/report_html.hpp"
#include "io/svg_text.hpp"

namespace thermovox {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// Decimals that show two digits of a sigma.
int decimalsFor(double sigma) {
  if (!(sigma > 0.0) || !std::isfinite(sigma)) return 4;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(sigma))), 0, 8);
}

std::string estimateOf(double value, double sigma, const std::string& unit) {
  const int decimals = decimalsFor(sigma);
  return numberText(value, decimals) + " &pm; " + numberText(sigma, decimals) + unit;
}

/// A matrix of correlations with the sigmas on its diagonal; cells are tinted by how strong they are.
std::string correlationTable(const Eigen::MatrixXd& covariance, const std::vector<std::string>& names,
                             const std::vector<std::string>& sigmas) {
  std::vector<std::string> heads{""};
  heads.insert(heads.end(), names.begin(), names.end());
  HtmlTable table(heads, std::string(names.size() + 1, 'r'));
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::vector<std::string> cells{"<b>" + names[i] + "</b>"};
    for (std::size_t j = 0; j < names.size(); ++j) {
      const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
      const double scale = std::sqrt(covariance(a, a) * covariance(b, b));
      const double share = scale > 0.0 ? covariance(a, b) / scale : std::nan("");
      if (i == j) {
        cells.push_back("<b>" + sigmas[i] + "</b>");
      } else if (!std::isfinite(share)) {
        cells.emplace_back("&ndash;");
      } else {
        cells.push_back(
            fmt::format("<span class=\"chip\" style=\"font-weight:normal;background:{}\">{}</span>",
                        hexOf(divergingColour(0.5 * share)), numberText(share, 2)));
      }
    }
    table.row(cells);
  }
  return table.html();
}

std::string poseCorrelation(const Matrix6d& covariance) {
  const std::vector<std::string> names{"rot. x", "rot. y", "rot. z", "x", "y", "z"};
  std::vector<std::string> sigmas;
  for (int i = 0; i < 6; ++i) {
    const double sigma = std::sqrt(covariance(i, i));
    sigmas.push_back(i < 3 ? numberText(sigma / kDegree, 3) + "&deg;" : numberText(1e3 * sigma, 2) + " mm");
  }
  return correlationTable(covariance, names, sigmas);
}

std::string poseTable(const ReportedPose& mounting) {
  const auto& q = mounting.pose.rotation.coeffs();
  HtmlTable table({"along the body's", "position, mm", "sigma, mm", "rotation about it,<br>sigma, &deg;"},
                  "lrrr");
  constexpr std::array<const char*, 3> kAxes{"x (forward)", "y (left)", "z (up)"};
  for (int i = 0; i < 3; ++i) {
    const double shift = 1e3 * std::sqrt(mounting.covariance(i + 3, i + 3));
    table.row({kAxes[static_cast<std::size_t>(i)], numberText(1e3 * mounting.pose.translation[i], 2),
               numberText(shift, 2), numberText(std::sqrt(mounting.covariance(i, i)) / kDegree, 3)});
  }
  const double turned = mounting.guess.rotation.angularDistance(mounting.pose.rotation) / kDegree;
  return table.html() +
         fmt::format(
             "<p>Quaternion x y z w: {}, {}, {}, {}. Against the rig's first guess it is turned by {}&deg; "
             "and shifted by {} mm.</p>\n",
             numberText(q[0], 6), numberText(q[1], 6), numberText(q[2], 6), numberText(q[3], 6),
             numberText(turned, 3),
             numberText(1e3 * (mounting.pose.translation - mounting.guess.translation).norm(), 1));
}

std::string transferTable(const CalibrationReport& report) {
  if (report.transfer.empty() || report.cameras.empty()) return {};
  HtmlTable table({"distance<br>m", "beside its pixel<br>px, one sigma", "on the object<br>mm"}, "rrr");
  const auto& numbers = report.cameras.front().intrinsics;
  const double focal = numbers.empty() ? std::nan("") : numbers.front().value;
  for (const ReportedTransfer& transfer : report.transfer) {
    table.row({fmt::format("{:g}", transfer.distance), numberText(transfer.sigma_px, 2),
               numberText(1e3 * transfer.distance * transfer.sigma_px / focal, 1)});
  }
  return "<h3>Pixel transfer error</h3>\n<p class=\"note\">How far beside its pixel in the " +
         escaped(report.cameras.front().name) +
         " a point of the laser may come to lie. Below about half a pixel the calibration is not what limits "
         "a "
         "map.</p>\n" +
         table.html();
}

std::string intrinsicsTable(const ReportedCamera& camera) {
  HtmlTable table({"", "value &pm; one sigma", "unit", "before", "change"}, "lrlrr");
  for (const ReportedNumber& number : camera.intrinsics) {
    const double sigma = number.sigma.value_or(0.0);
    const int decimals = decimalsFor(sigma);
    table.row({escaped(number.name),
               number.sigma ? estimateOf(number.value, sigma, "") : numberText(number.value, 4) + " (kept)",
               escaped(number.unit), numberText(number.guess, decimals),
               number.sigma ? numberText(number.value - number.guess, decimals) : ""});
  }
  return table.html();
}

std::string intrinsicsCorrelation(const ReportedCamera& camera) {
  std::vector<std::string> names, sigmas;
  std::vector<Eigen::Index> free;
  for (std::size_t i = 0; i < camera.intrinsics.size(); ++i) {
    const auto place = static_cast<Eigen::Index>(i);
    if (!camera.intrinsics[i].sigma || place >= camera.covariance.rows()) continue;
    const double sigma = *camera.intrinsics[i].sigma;
    free.push_back(place);
    names.push_back(escaped(camera.intrinsics[i].name));
    sigmas.push_back(numberText(sigma, decimalsFor(sigma)));
  }
  if (free.empty()) return {};
  return "<div class=\"block\"><h3>How its numbers err together</h3>\n<p class=\"note\">Correlations; sigmas "
         "on the "
         "diagonal.</p>\n" +
         correlationTable(camera.covariance(free, free), names, sigmas) + "</div>\n";
}

std::string figure(const std::string& drawing, const std::string& caption) {
  return "<figure>" + drawing + "<figcaption>" + caption + "</figcaption></figure>\n";
}

std::string cameraFigures(const CalibrationReport& report, std::size_t camera) {
  const ReportedCamera& lens = report.cameras[camera];
  const QuiverScale scale = quiverScale(report, camera, 0.12 * lens.width_px);
  const Coverage coverage = coverageOf(report, camera);
  const std::size_t cells = coverage.corners.size(), covered = static_cast<std::size_t>(coverage.covered());
  std::string text = "<div class=\"columns\">\n";
  text += figure(residualMap(report, camera, scale),
                 fmt::format("Residuals of all captures, {:g} times as long as they are. Thick: the mean of "
                             "each part of the image; it should be much shorter than the others.",
                             scale.times));
  text += figure(coverageMap(report, camera),
                 "How many corners lay where: " + shareText(covered, cells) +
                     " of the image has some. Where there is 0, distortion is extrapolated.");
  const std::string histogram = residualHistogram(report, camera);
  if (!histogram.empty())
    text += figure(histogram,
                   "How often residuals in u and v were how large (grey), and a Gaussian of the same width "
                   "(red). Long tails are corners that were found wrongly.");
  const std::string bars = captureBars(report, camera);
  if (!bars.empty())
    text += figure(bars,
                   "Residuals of each capture, px rms, with its number. One that stands out was blurred, "
                   "or its board was bent or moved.");
  return text + "</div>\n";
}

}  // namespace

std::string mountingSection(const CalibrationReport& report) {
  if (report.poses.empty() && report.laser.empty()) return {};
  std::string text = "<h2 id=\"mounting\">Mounting</h2>\n";
  std::vector<std::pair<std::string, std::string>> facts;
  for (const auto& [name, value] : report.laser) facts.emplace_back(escaped(name), escaped(value));
  if (!facts.empty()) text += factTable(facts);
  text += transferTable(report);
  for (const ReportedPose& mounting : report.poses) {
    text += "<h3>" + escaped(mounting.name) + "</h3>\n";
    if (!mounting.note.empty()) text += "<p class=\"note\">" + escaped(mounting.note) + "</p>\n";
    text +=
        poseTable(mounting) +
        "<p class=\"note\">Correlations of these six, along the body's axes; sigmas on the diagonal.</p>\n" +
        poseCorrelation(mounting.covariance);
  }
  return text;
}

std::string cameraSection(const CalibrationReport& report, std::size_t camera) {
  const ReportedCamera& lens = report.cameras[camera];
  std::string text = fmt::format("<h2 id=\"camera-{}\">The {}</h2>\n<p>{} &times; {} px. ", camera,
                                 escaped(lens.name), lens.width_px, lens.height_px);
  if (coverageOf(report, camera).covered() == 0)
    return text + "No corner of a board counts in its images.</p>\n" + intrinsicsTable(lens);
  text += fmt::format(
      "{} ({} left out), reprojection error <b>{} px</b> rms; corners err {} times as far as each claims by "
      "its "
      "own image.</p>\n",
      countText(static_cast<std::size_t>(std::max(0, lens.corners)), "corner"), lens.left_out,
      numberText(lens.rms_px, 3), numberText(lens.corner_factor, 2));
  return text + cameraFigures(report, camera) + intrinsicsTable(lens) + intrinsicsCorrelation(lens);
}

}  // namespace thermovox
