// Writes the report of a plant with fifty hot spots, seen by three missions, for the test in a browser.
//   reported_plant REPORT.html REPORT.pdf
#include "tests/io/reported_plant.hpp"

#include <cstdio>
#include <exception>

#include "io/report_pdf.hpp"

namespace {

void write(const std::filesystem::path& html_file, const std::filesystem::path& pdf_file) {
  using namespace thermovox;
  test::ReportedPlant plant;
  std::vector<test::ReportedPlant::Rise> rises;
  for (int i = 0; i < 50; ++i) rises.emplace_back(20.0 + i);
  plant.fly("<monday>, a name that is so long that no table has room for it in one line", rises);
  rises[3] = std::nullopt;
  plant.fly("tuesday", rises);
  rises[4] = 0.0;
  rises[5] = 60.0;
  plant.fly("wednesday", rises);
  const std::string html = hotspotReportHtml(plant.report());
  AtomicFile file(html_file, Existing::replace);
  file.write(html);
  file.commit();
  writePdf(pdf_file, html, {.browser = findBrowser()}, Existing::replace);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 3) return 2;
    write(argv[1], argv[2]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
