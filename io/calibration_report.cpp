#include "io/calibration_report.hpp"

#include <algorithm>

#include "io/calibration_sections.hpp"
#include "io/report_html.hpp"
#include "io/svg_text.hpp"

namespace thermovox {
namespace {

std::string listOf(const std::vector<std::string>& sentences) {
  if (sentences.empty()) return {};
  std::string text = "<ul>\n";
  for (const std::string& sentence : sentences) text += "<li>" + escaped(sentence) + "</li>\n";
  return text + "</ul>\n";
}

std::string verdictOf(const CalibrationReport& report) {
  std::string text = report.determined ? "<div class=\"verdict\">" : "<div class=\"verdict alarm\">";
  if (report.determined) {
    text += "<p><b>These captures determine " + escaped(report.task) + "</b>" +
            (report.warnings.empty() ? "." : ", with the warnings below.") + "</p>\n";
  } else {
    text +=
        "<p><b>These captures do not determine " + escaped(report.task) + ":</b> " + escaped(report.reason) +
        ".</p>\n<p>No rig was written. What follows shows what the captures hold and what they lack; take "
        "more of what is missing and calibrate again with all of them.</p>\n";
  }
  return text + listOf(report.findings) + "</div>\n";
}

constexpr const char* kMethods = R"html(<dl>
<dt>Corners</dt><dd>Where two edges of squares cross, fitted to the image with the blur of the optics; each brings its own
uncertainty. The order is row by row from the ringed corner.</dd>
<dt>Residual</dt><dd>Where a corner was found less where the calibrated camera would see it. A good lens model leaves residuals
that point anywhere; arrows that agree over a part of the image mean that the lens is modelled wrongly there.</dd>
<dt>Left out</dt><dd>Corners that are more than 3.5 robust sigmas off, returns that are as far off the board's plane, captures in which
the laser saw the board in another place than the cameras did.</dd>
<dt>Reprojection error</dt><dd>The root mean square of the residuals of the corners that count, in u and v together for each corner.
A small one does not prove a good calibration: boards that are all held alike fit any answer. The sigmas do.</dd>
<dt>Sigmas</dt><dd>One standard deviation, from one bundle of corners, planes and edges of all captures, with their noise estimated from
what is left over. Intrinsics, mountings and board poses are unknown together, so that what one does not know the other bears.</dd>
<dt>Correlation</dt><dd>+1 or -1: two numbers err together; what matters is then often known better than each of them.</dd>
<dt>Pixel transfer</dt><dd>How far a point that the laser measures may come to lie beside its true pixel: what a map is
made of. Errors of rotation and principal point partly cancel in it.</dd>
</dl>
)html";

}  // namespace

std::string calibrationCover(const CalibrationReport& report) {
  std::string text = "<header id=\"top\"><h1>" + named(report.title) +
                     "</h1>\n<p class=\"lead\">Calibration of " + escaped(report.task) + " from " +
                     countText(report.captures.size(), "capture") + " of " + escaped(report.board) +
                     ". Made with thermovox " + escaped(report.version) + ".</p>\n<nav>";
  if (!report.poses.empty() || !report.laser.empty()) text += "<a href=\"#mounting\">mounting</a> ";
  if (!report.cameras.empty()) text += "<a href=\"#camera-0\">cameras</a> ";
  text +=
      "<a href=\"#boards\">how the board was held</a> <a href=\"#captures\">captures</a> <a "
      "href=\"#methods\">how the numbers were made</a></nav></header>\n" +
      verdictOf(report);
  if (!report.warnings.empty()) text += "<h3>Warnings</h3>\n" + listOf(report.warnings);
  return text;
}

std::string calibrationMethods(const CalibrationReport& /*report*/) {
  return std::string("<h2 id=\"methods\">How the numbers were made</h2>\n") + kMethods;
}

std::string calibrationReportHtml(const CalibrationReport& report) {
  std::string body = calibrationCover(report) + mountingSection(report);
  for (std::size_t camera = 0; camera < report.cameras.size(); ++camera)
    body += cameraSection(report, camera);
  body += boardSection(report) + captureSection(report) + calibrationMethods(report);
  return htmlDocument("Calibration of " + report.title, body);
}

void writeCalibrationHtml(const std::filesystem::path& file, const CalibrationReport& report,
                          Existing existing) {
  AtomicFile out(file, existing);
  out.write(calibrationReportHtml(report));
  out.commit();
}

}  // namespace thermovox
