#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "io/calibration_plots.hpp"
#include "io/calibration_sections.hpp"
#include "io/report_html.hpp"
#include "io/svg_text.hpp"

namespace thermovox {
namespace {

constexpr double kDegree = 0.017453292519943295;

const ReportedView* viewOf(const ReportedCapture& capture, std::size_t camera) {
  const auto view = std::find_if(capture.views.begin(), capture.views.end(),
                                 [&](const ReportedView& other) { return other.camera == camera; });
  return view == capture.views.end() ? nullptr : &*view;
}

/// Of the board's normal against the optical axis.
double tiltOf(const ReportedBoard& board) {
  const double x = std::tan(board.tilt_x_deg * kDegree), y = std::tan(board.tilt_y_deg * kDegree);
  return std::atan(std::hypot(x, y)) / kDegree;
}

std::string cornersText(const ReportedView* view) {
  if (view == nullptr) return "no image";
  if (view->corners.empty()) return "<b>no board</b>";
  const ViewNumbers numbers = numbersOf(*view);
  if (numbers.counted == 0) return "left out";
  return fmt::format("{}{} &middot; {}", numbers.counted,
                     numbers.left_out > 0 ? fmt::format(" (&minus;{})", numbers.left_out) : "",
                     numberText(numbers.rms_px, 3));
}

bool anyRanges(const CalibrationReport& report) {
  return std::any_of(report.captures.begin(), report.captures.end(),
                     [](const ReportedCapture& capture) { return capture.ranges.has_value(); });
}

std::string verdictOf(const ReportedCapture& capture) {
  std::string text =
      capture.counts ? "<span class=\"chip s0\">counts</span> " : "<span class=\"chip s3\">left out</span> ";
  text += escaped(capture.reason);
  return text;
}

std::string captureTable(const CalibrationReport& report) {
  std::vector<std::string> heads{"#", "capture", "distance<br>m", "tilt<br>&deg;"};
  std::string alignment = "rlrr";
  for (const ReportedCamera& camera : report.cameras) {
    heads.push_back(escaped(camera.name) + "<br>corners&nbsp;&middot;&nbsp;px");
    alignment += "r";
  }
  const bool ranges = anyRanges(report);
  if (ranges) {
    heads.insert(heads.end(), {"returns", "offset<br>mm", "of it bias<br>mm"});
    alignment += "rrr";
  }
  heads.emplace_back("verdict");
  HtmlTable table(heads, alignment + "l");
  for (std::size_t i = 0; i < report.captures.size(); ++i) {
    const ReportedCapture& capture = report.captures[i];
    std::vector<std::string> cells{fmt::format("<a href=\"#capture-{0}\">{0}</a>", i + 1),
                                   named(capture.name)};
    cells.push_back(capture.board ? numberText(capture.board->distance, 2) : "");
    cells.push_back(capture.board ? numberText(tiltOf(*capture.board), 0) : "");
    for (std::size_t camera = 0; camera < report.cameras.size(); ++camera)
      cells.push_back(cornersText(viewOf(capture, camera)));
    if (ranges && capture.ranges) {
      const ReportedRanges& seen = *capture.ranges;
      cells.push_back(groupedText(seen.returns) +
                      (seen.left_out > 0 ? " (&minus;" + groupedText(seen.left_out) + ")" : ""));
      cells.push_back(numberText(seen.offset_mm, 1));
      cells.push_back(seen.bias_mm ? numberText(*seen.bias_mm, 1) : "");
    } else if (ranges) {
      cells.insert(cells.end(), {"", "", ""});
    }
    cells.push_back(verdictOf(capture));
    table.row(cells);
  }
  return table.html();
}

std::string figure(const std::string& drawing, const std::string& caption) {
  return "<figure>" + drawing + "<figcaption>" + caption + "</figcaption></figure>\n";
}

std::string viewFigure(const CalibrationReport& report, const ReportedView& view, const std::string& id) {
  const QuiverScale scale = quiverScale(report, view.camera, cornerSpacing(report, view.camera));
  const std::string drawing = viewDrawing(view, report.columns, scale, id);
  std::string caption = named(view.file) + ": ";
  if (view.corners.empty()) {
    caption +=
        "<b>no board was found</b>. Is it whole in the image, with its border, and warmer or cooler than "
        "what "
        "is around?";
  } else {
    const ViewNumbers numbers = numbersOf(view);
    caption += countText(numbers.counted, "corner") +
               (numbers.left_out > 0 ? fmt::format(", {} left out", numbers.left_out) : "");
    if (numbers.counted > 0 && std::isfinite(numbers.rms_px))
      caption +=
          fmt::format(", {} px rms; residuals {:g} times as long",
                      numbers.rms_px < 1e4 ? numberText(numbers.rms_px, 3) : "&gt; 10000", scale.times);
    caption += ".";
  }
  if (!view.reason.empty()) caption += " <b>" + escaped(view.reason) + "</b>";
  return figure(drawing, caption);
}

std::string returnsFigure(const CalibrationReport& report, const ReportedCapture& capture,
                          const ReportedView& view, const std::string& id) {
  const double limit = residualLimit(report);
  const std::string what =
      report.by_first_guess
          ? "The laser's returns where the rig's <b>first guess</b> puts them"
          : "The laser's returns on the board (of a beam their mean), those left out as rings";
  return figure(returnsDrawing(view, capture, limit, id) + residualBar(limit),
                what + ". Blue: before the board, red: behind it, along the ray.");
}

std::string captureFacts(const ReportedCapture& capture) {
  std::vector<std::pair<std::string, std::string>> facts;
  if (capture.board) {
    facts.emplace_back("distance", numberText(capture.board->distance, 3) + " m");
    facts.emplace_back("tilt about the camera's x, y", numberText(capture.board->tilt_x_deg, 1) + "&deg;, " +
                                                           numberText(capture.board->tilt_y_deg, 1) +
                                                           "&deg;");
  }
  if (capture.ranges) {
    const ReportedRanges& seen = *capture.ranges;
    facts.emplace_back("returns on the board", groupedText(seen.returns));
    facts.emplace_back("of them left out", groupedText(seen.left_out));
    facts.emplace_back("mean offset behind the board", numberText(seen.offset_mm, 1) + " mm");
    if (seen.bias_mm) facts.emplace_back("of it taken for bias", numberText(*seen.bias_mm, 1) + " mm");
    facts.emplace_back("about their own plane", numberText(seen.scatter_mm, 1) + " mm");
  }
  return facts.empty() ? "" : "<div class=\"beside\">" + factTable(facts) + "</div>\n";
}

std::string capturePage(const CalibrationReport& report, std::size_t i) {
  const ReportedCapture& capture = report.captures[i];
  std::string text = fmt::format("<div class=\"whole\" id=\"capture-{}\"><h3>{}. {}</h3>\n<p>", i + 1, i + 1,
                                 named(capture.name));
  text += verdictOf(capture) + "</p>\n<div class=\"capture\">\n";
  const std::string id = fmt::format("image-{}-", i + 1);
  const ReportedView* reference = viewOf(capture, 0);
  for (const ReportedView& view : capture.views) {
    text += viewFigure(report, view, id + std::to_string(view.camera));
    if (&view == reference && !capture.returns.empty() && view.picture)
      text += returnsFigure(report, capture, view, id + "0");
  }
  return text + captureFacts(capture) + "</div></div>\n";
}

/// How many boards that count were tilted which way.
std::string directionTable(const CalibrationReport& report) {
  constexpr double kTilted = 15.0;  // degrees
  std::array<std::size_t, 4> counts{};
  double nearest = 1e9, farthest = 0.0;
  for (const ReportedCapture& capture : report.captures) {
    if (!capture.counts || !capture.board) continue;
    const ReportedBoard& board = *capture.board;
    counts[0] += board.tilt_y_deg >= kTilted ? 1 : 0;
    counts[1] += board.tilt_y_deg <= -kTilted ? 1 : 0;
    counts[2] += board.tilt_x_deg <= -kTilted ? 1 : 0;
    counts[3] += board.tilt_x_deg >= kTilted ? 1 : 0;
    nearest = std::min(nearest, board.distance);
    farthest = std::max(farthest, board.distance);
  }
  if (nearest > farthest) return "<p>None of them counts.</p>\n";
  return factTable({{"facing left by 15&deg; or more", countText(counts[0], "board")},
                    {"facing right", countText(counts[1], "board")},
                    {"facing up", countText(counts[2], "board")},
                    {"facing down", countText(counts[3], "board")},
                    {"distances", numberText(nearest, 2) + " to " + numberText(farthest, 2) + " m"}}) +
         "<p class=\"note\">Left, right, up and down are those of the image; only captures that count.</p>\n";
}

}  // namespace

std::string boardSection(const CalibrationReport& report) {
  const std::string plot = tiltPlot(report);
  std::string text = "<h2 id=\"boards\">How the board was held</h2>\n";
  if (plot.empty()) return text + "<p>In no capture is it known where the board was.</p>\n";
  return text + "<div class=\"columns\"><figure>" + plot +
         "<figcaption>Every dot is a capture with its number; hollow ones are left "
         "out.</figcaption></figure>\n"
         "<div>" +
         directionTable(report) +
         "<p>A board that faces the camera tells nothing of what turning it would tell. Dots should lie all "
         "around, most of them between the dashed rings (30 and 60 degrees), in every direction near ones "
         "and far "
         "ones, the farthest three times as far as the nearest.</p>\n<p>What is missing here is what the "
         "next "
         "captures should show: tilt the board towards the empty sectors.</p></div></div>\n";
}

std::string captureSection(const CalibrationReport& report) {
  std::string text = "<h2 id=\"captures\" class=\"sheet\">Captures</h2>\n";
  if (report.captures.empty()) return text + "<p>There is none.</p>\n";
  text += captureTable(report);
  if (anyRanges(report))
    text +=
        "<p class=\"note\">Offset: the mean distance of the returns behind the board of the images, along "
        "the rays; "
        "a part of it is taken for an error that all ranges of the capture share (bias).</p>\n";
  text +=
      "<p class=\"note\">In the pictures: green crosses are corners as they were found, the orange line is "
      "their "
      "first row with a ring about the first one, the blue grid is the board as the calibration has it, red "
      "lines "
      "are residuals, pink crosses are corners that were left out. The small frame shows which part of the "
      "image "
      "it is.</p>\n";
  for (std::size_t i = 0; i < report.captures.size(); ++i) text += capturePage(report, i);
  return text;
}

}  // namespace thermovox
