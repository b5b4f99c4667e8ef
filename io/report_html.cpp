#include "io/report_html.hpp"

#include <fmt/format.h>

#include <cassert>
#include <chrono>
#include <utility>

#include "io/number_text.hpp"
#include "io/report_style.hpp"

namespace thermovox {
namespace {

constexpr const char* kHead = R"html(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'">
<link rel="icon" href="data:,">
)html";

std::string entityOf(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      return {c};
  }
}

}  // namespace

std::string escaped(std::string_view text) {
  const bool good = isPrintableUtf8(text);
  std::string html;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    html += !good && (byte < 0x20 || byte > 0x7E) ? "?" : entityOf(c);
  }
  return html;
}

std::string named(std::string_view text) {
  return "<bdi>" + escaped(text) + "</bdi>";
}

std::string dateText(Time time) {
  constexpr double kCalendar = 1e8;  // seconds: no recorder that knows the year is from before 1973
  if (toUnixSeconds(time) < kCalendar) return fmt::format("{:.3f} s", toUnixSeconds(time));
  using namespace std::chrono;
  const auto whole = floor<seconds>(time.time_since_epoch());
  const auto days_since = floor<days>(whole);
  const year_month_day date{sys_days(days_since)};
  const hh_mm_ss clock(whole - days_since);
  return fmt::format("<span class=\"date\">{:04}-{:02}-{:02} {:02}:{:02}:{:02} UTC</span>",
                     static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                     static_cast<unsigned>(date.day()), clock.hours().count(), clock.minutes().count(),
                     clock.seconds().count());
}

std::string estimateText(const Estimate& estimate) {
  return fmt::format("{:.1f} &pm; {:.1f}", estimate.value, estimate.sigma);
}

std::string vectorText(const Eigen::Vector3d& v, int decimals) {
  return fmt::format("{:.{}f}, {:.{}f}, {:.{}f}", v.x(), decimals, v.y(), decimals, v.z(), decimals);
}

std::string groupedText(std::size_t number) {
  std::string text = std::to_string(number);
  for (std::ptrdiff_t i = std::ssize(text) - 3; i > 0; i -= 3) {
    text.insert(static_cast<std::size_t>(i), "&#8239;");
  }
  return text;
}

std::string shareText(std::size_t part, std::size_t whole) {
  if (whole == 0) return "0 %";
  const double percent = 100.0 * static_cast<double>(part) / static_cast<double>(whole);
  return fmt::format("{:.{}f} %", percent, percent < 10.0 && part > 0 ? 1 : 0);
}

std::string countText(std::size_t number, const std::string& noun) {
  return groupedText(number) + " " + noun + (number == 1 ? "" : "s");
}

HtmlTable::HtmlTable(std::vector<std::string> heads, std::string alignment)
    : alignment_(std::move(alignment)) {
  head_ = line(heads, "th");
}

void HtmlTable::row(const std::vector<std::string>& html) {
  body_ += line(html, "td");
  ++rows_;
}

std::string HtmlTable::line(const std::vector<std::string>& html, const char* tag) const {
  assert(html.size() == alignment_.size());
  std::string text = "<tr>";
  for (std::size_t i = 0; i < html.size(); ++i) {
    text += fmt::format("<{0} class=\"{1}\">{2}</{0}>", tag, alignment_[i], html[i]);
  }
  return text + "</tr>\n";
}

std::string HtmlTable::html() const {
  constexpr std::size_t kShort = 12;  // rows: a third of a page
  const std::string kind = rows_ > kShort ? "scroll" : "scroll whole";
  return "<div class=\"" + kind + "\"><table>\n<thead>" + head_ + "</thead>\n<tbody>\n" + body_ +
         "</tbody>\n</table></div>\n";
}

std::string factTable(const std::vector<std::pair<std::string, std::string>>& html) {
  std::string text = "<table class=\"facts\"><tbody>\n";
  for (const auto& [name, value] : html) {
    text += "<tr><th>" + name + "</th><td>" + value + "</td></tr>\n";
  }
  return text + "</tbody></table>\n";
}

std::string pictureUrl(std::string_view bytes) {
  constexpr const char* kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text = bytes.starts_with("\xFF\xD8") ? "data:image/jpeg;base64," : "data:image/png;base64,";
  text.reserve(text.size() + (bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k > bytes.size() ? '=' : kLetters[group >> (18 - 6 * k) & 63U];
    }
  }
  return text;
}

std::string htmlDocument(const std::string& title, const std::string& body) {
  return kHead + ("<title>" + escaped(title) + "</title>\n<style>") + kReportStyle +
         "</style>\n</head>\n<body>\n" + body + "</body>\n</html>\n";
}

}  // namespace thermovox
