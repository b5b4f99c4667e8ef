#include "io/calibration_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "projection/error.hpp"
#include "tests/io/html_checks.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using test::countOf;
using test::expectSound;
using testing::HasSubstr;
using testing::Not;

constexpr int kColumns = 4, kRows = 3;

GreyImage checkered(int width, int height) {
  GreyImage image{width, height, {}};
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) image.values.push_back((u / 8 + v / 8) % 2 == 0 ? 20.0F : 24.0F);
  }
  return image;
}

ReportedView viewOf(std::size_t camera, const std::string& file, int width, int height) {
  ReportedView view{.camera = camera, .file = file, .picture = {}, .corners = {}, .reason = {}};
  std::vector<Eigen::Vector2d> marks;
  for (int i = 0; i < kColumns * kRows; ++i) {
    const Eigen::Vector2d found(0.2 * width + 8.0 * (i % kColumns), 0.3 * height + 8.0 * (i / kColumns));
    const Eigen::Vector2d off(0.05 * std::sin(3.0 * i), 0.05 * std::cos(5.0 * i));
    view.corners.push_back({found, found + off, i != 5});
    marks.push_back(found);
  }
  view.picture = calibrationPicture(checkered(width, height), marks);
  return view;
}

ReportedCapture captureOf(int number) {
  ReportedCapture capture;
  capture.name = "00" + std::to_string(number) + "_cloud.pcd";
  capture.views = {viewOf(0, "thermal.tiff", 160, 120), viewOf(1, "visible.jpg", 640, 480)};
  capture.board = ReportedBoard{0.5 + 0.1 * number, 20.0 - 10.0 * number, 5.0 * number};
  for (int i = 0; i < 9; ++i) capture.returns.push_back({{40.0 + i, 40.0}, 2.0 * i - 8.0, i != 0});
  capture.ranges = ReportedRanges{8, 1, 0.4, 0.1, 7.9};
  return capture;
}

ReportedCamera cameraOf(const std::string& name, int width, int height) {
  return {.name = name,
          .width_px = width,
          .height_px = height,
          .corners = 33,
          .left_out = 3,
          .rms_px = 0.05,
          .corner_factor = 1.1,
          .intrinsics = {{"fx", "px", 147.2, 0.3, 150.0}, {"k1", "", -0.2, std::nullopt, -0.2}},
          .covariance = Eigen::Vector2d(0.09, 0.0).asDiagonal().toDenseMatrix()};
}

CalibrationReport reportOf(int captures = 3) {
  CalibrationReport report;
  report.title = "hall";
  report.task = "the laser's pose";
  report.version = "1.2.3";
  report.findings = {"A finding."};
  report.board = "a board";
  report.columns = kColumns;
  report.cameras = {cameraOf("thermal camera", 160, 120), cameraOf("visible camera", 640, 480)};
  ReportedPose pose{.name = "T_body_laser", .note = "", .pose = {}, .guess = {}};
  pose.covariance.diagonal() << 1e-6, 1e-6, 1e-6, 4e-6, 4e-6, 4e-6;
  report.poses = {pose};
  report.transfer = {{1.0, 0.1}, {3.0, 0.2}, {10.0, 0.25}};
  report.laser = {{"kind of laser", "cloud"}};
  for (int i = 0; i < captures; ++i) report.captures.push_back(captureOf(i));
  return report;
}

/// Numbers that are none.
void expectFinite(const std::string& html) {
  for (const char* word : {"nan", "inf", "NaN", "-0.00\""}) {
    for (const char* before : {" ", ">", "\"", "M", "L", "l", ":"}) {
      EXPECT_THAT(html, Not(HasSubstr(std::string(before) + word + " "))) << word;
      EXPECT_THAT(html, Not(HasSubstr(std::string(before) + word + "<"))) << word;
      EXPECT_THAT(html, Not(HasSubstr(std::string(before) + word + "\""))) << word;
    }
  }
}

TEST(CalibrationReport, EveryCaptureHasItsRowAndItsPictures) {
  const std::string html = calibrationReportHtml(reportOf(4));
  expectSound(html);
  expectFinite(html);
  for (int i = 1; i <= 4; ++i) {
    EXPECT_EQ(countOf(html, "id=\"capture-" + std::to_string(i) + "\""), 1U);
    EXPECT_EQ(countOf(html, "href=\"#capture-" + std::to_string(i) + "\""), 1U);
    EXPECT_EQ(countOf(html, "href=\"#image-" + std::to_string(i) + "-0\""), 1U);  // the laser's returns
  }
  EXPECT_EQ(countOf(html, "href=\"data:image/"), 8U);  // two cameras each
  EXPECT_THAT(html, HasSubstr("<b>These captures determine the laser&#39;s pose</b>."));
  EXPECT_THAT(html, HasSubstr("147.20 &pm; 0.30"));
  EXPECT_THAT(html, HasSubstr("(kept)"));
  EXPECT_THAT(html, HasSubstr("11 (&minus;1)"));  // a corner left out
}

TEST(CalibrationReport, TheSameInputGivesTheSameBytes) {
  EXPECT_EQ(calibrationReportHtml(reportOf()), calibrationReportHtml(reportOf()));
}

TEST(CalibrationReport, SaysWhyItCannotBeDetermined) {
  CalibrationReport report = reportOf();
  report.determined = false;
  report.reason = "all boards face the same way";
  report.by_first_guess = true;
  report.captures[1].counts = false;
  report.captures[1].reason = "the board moved";
  report.captures[2].views[0].corners.clear();
  const std::string html = calibrationReportHtml(report);
  expectSound(html);
  EXPECT_THAT(html, HasSubstr("verdict alarm"));
  EXPECT_THAT(html, HasSubstr("all boards face the same way"));
  EXPECT_THAT(html, HasSubstr("first guess</b> puts them"));
  EXPECT_THAT(html, HasSubstr("left out</span> the board moved"));
  EXPECT_THAT(html, HasSubstr("no board was found"));
}

TEST(CalibrationReport, WarningsStandUnderTheVerdict) {
  CalibrationReport report = reportOf();
  report.warnings = {"six captures count"};
  const std::string html = calibrationReportHtml(report);
  EXPECT_THAT(html, HasSubstr("with the warnings below."));
  EXPECT_THAT(html, HasSubstr("<li>six captures count</li>"));
}

TEST(CalibrationReport, NothingInItIsNoFault) {
  CalibrationReport bare;
  bare.columns = 0;
  const std::string html = calibrationReportHtml(bare);
  expectSound(html);
  EXPECT_THAT(html, HasSubstr("<p>There is none.</p>"));
  CalibrationReport report = reportOf();
  for (ReportedCapture& capture : report.captures) capture = {.name = capture.name};
  for (ReportedCamera& camera : report.cameras) camera = {.name = camera.name};
  report.poses.clear();
  report.laser.clear();
  const std::string empty = calibrationReportHtml(report);
  expectSound(empty);
  expectFinite(empty);
  EXPECT_THAT(empty, HasSubstr("No corner of a board counts in its images."));
}

TEST(CalibrationReport, WhatIsNoNumberIsADash) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  CalibrationReport report = reportOf();
  report.captures[0].views[0].corners[2] = {{kNaN, 3.0}, Eigen::Vector2d(1.0, kNaN), true};
  report.captures[0].returns[1] = {{kNaN, 3.0}, kNaN, true};
  report.captures[0].board = ReportedBoard{kNaN, kNaN, kNaN};
  report.captures[1].ranges = ReportedRanges{0, 0, kNaN, kNaN, std::numeric_limits<double>::infinity()};
  report.cameras[0].intrinsics[0] = {"fx", "px", kNaN, kNaN, kNaN};
  report.cameras[1].rms_px = kNaN;
  report.cameras[1].covariance(0, 0) = kNaN;
  report.poses[0].covariance.setConstant(kNaN);
  report.poses[0].pose.translation.setConstant(kNaN);
  report.transfer[0].sigma_px = kNaN;
  const std::string html = calibrationReportHtml(report);
  expectSound(html);
  expectFinite(html);
  EXPECT_THAT(html, HasSubstr("&ndash;"));
}

TEST(CalibrationReport, NoTextFromOutsideBecomesMarkup) {
  const std::string evil = "<script>alert(1)</script>\"'&";
  CalibrationReport report = reportOf();
  report.title = report.board = report.reason = report.task = evil;
  report.determined = false;
  report.findings = report.warnings = {evil};
  report.laser = {{evil, evil}};
  report.poses[0].name = report.poses[0].note = evil;
  report.cameras[0].name = report.cameras[0].intrinsics[0].name = report.cameras[0].intrinsics[0].unit = evil;
  report.captures[0].name = report.captures[0].reason = evil;
  report.captures[0].views[0].file = report.captures[0].views[0].reason = evil;
  const std::string html = calibrationReportHtml(report);
  expectSound(html);
  EXPECT_THAT(html, Not(HasSubstr("alert(1)<")));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;alert(1)&lt;/script&gt;&quot;&#39;&amp;"));
}

TEST(CalibrationReport, IsWrittenWholeAndReplacesNothingUnasked) {
  const test::TestFolder folder;
  writeCalibrationHtml(folder / "r.html", reportOf(), Existing::refuse);
  EXPECT_EQ(test::bytesOf(folder / "r.html"), calibrationReportHtml(reportOf()));
  EXPECT_THROW(writeCalibrationHtml(folder / "r.html", reportOf(1), Existing::refuse), DataError);
  writeCalibrationHtml(folder / "r.html", reportOf(1), Existing::replace);
  EXPECT_EQ(test::bytesOf(folder / "r.html"), calibrationReportHtml(reportOf(1)));
}

TEST(CalibrationPictureTest, ShowsTheMarksWithSomethingAroundThem) {
  const std::vector<Eigen::Vector2d> marks{{60.0, 40.0}, {90.0, 60.0}};
  const CalibrationPicture part = calibrationPicture(checkered(160, 120), marks);
  for (const Eigen::Vector2d& mark : marks) EXPECT_TRUE(part.window.contains(mark));
  EXPECT_LT(part.window.sizes().x(), 80.0);
  EXPECT_NEAR(part.window.sizes().x() / part.window.sizes().y(), 160.0 / 120.0, 0.05);
  EXPECT_TRUE(part.bytes.starts_with("\x89PNG"));
  const CalibrationPicture all = calibrationPicture(checkered(1280, 960), {});
  EXPECT_EQ(all.window.sizes(), Eigen::Vector2d(1280.0, 960.0));
  EXPECT_TRUE(all.bytes.starts_with("\xFF\xD8"));  // a JPEG
}

TEST(CalibrationPictureTest, AnImageWithoutContrastIsAPictureToo) {
  const GreyImage flat{32, 24, std::vector<float>(32U * 24U, 21.5F)};
  EXPECT_TRUE(calibrationPicture(flat, {}).bytes.starts_with("\x89PNG"));
  const std::vector<Eigen::Vector2d> outside{{-50.0, 400.0}};
  EXPECT_FALSE(calibrationPicture(flat, outside).bytes.empty());
}

}  // namespace
}  // namespace thermovox
